// What tests/wasm/deno.test.mjs runs in Deno: the package's worker, a file, and an aborted call.
import * as domelight from 'domelight';

const data = Float32Array.from({length: 3 * 64 * 32}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024);
const environment = await domelight.fromPixels({data, width: 64, height: 32});
const {levels} = await domelight.prefilter(environment, {size: 16, levels: 2});
const file = await domelight.read(new TextEncoder().encode('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n' + '\x40\x40\x40\x7f'.repeat(8)));
const abort = new AbortController(), ended = domelight.bake(environment, {size: 512, signal: abort.signal}).catch(error => error.name);
setTimeout(() => abort.abort(), 20);
console.log(JSON.stringify({level: [...levels[1].data], file: [...(await file.latlong()).data], ended: await ended}));
domelight.terminate();
