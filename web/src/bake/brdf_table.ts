// The table of the split sum, which belongs to no environment: computed by the library when the app is built (vite.config.ts).

import url from 'brdf_table.bin?url';
import type {BrdfTable} from './types';

export async function brdfTable(): Promise<BrdfTable> {
    const pairs = new Uint16Array(await (await fetch(url)).arrayBuffer()), texels = new Uint16Array(2 * pairs.length);
    pairs.forEach((v, k) => (texels[4 * (k >> 1) + (k & 1)] = v));
    return {size: Math.sqrt(pairs.length / 2), texels};
}
