// node npm_inline.mjs MODULE OUT: writes inline.js of the npm package, which has the WebAssembly module in it.
import fs from 'node:fs';
import zlib from 'node:zlib';

const [module, out] = process.argv.slice(2);
fs.writeFileSync(out, `// domelight.wasm, compressed by gzip, in base64. Made by scripts/npm_inline.mjs.
const text = '${zlib.gzipSync(fs.readFileSync(module), {level: 9}).toString('base64')}';
const packed = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
export const module = new Uint8Array(await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
`);
