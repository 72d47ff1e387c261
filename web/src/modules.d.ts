declare module 'domelight.wasm?url' {
    const url: string;
    export default url;
}
