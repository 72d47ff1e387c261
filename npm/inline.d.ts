/** domelight.wasm in this file, for pages that fetch nothing: configure({module}) of 'domelight', or load({module}) of 'domelight/library'. */
export const module: Uint8Array;
