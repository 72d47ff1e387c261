// Files that vite.config.ts names.
declare module 'domelight.wasm?url' {
    const url: string;
    export default url;
}
declare module 'domelight-bake.wasm?url' {
    const url: string;
    export default url;
}
declare module 'brdf_table.bin?url' {
    const url: string;
    export default url;
}
declare module 'basis_transcoder.js?url' {
    const url: string;
    export default url;
}
