// The table of the split sum as a file of the app: pairs of half floats. It belongs to no environment, and takes longer than the first picture.

import fs from 'node:fs';
import {load} from '../../npm/library.js';

const k_size = 128;

/// Has the library of a WebAssembly module compute the table, unless the file is newer than the module.
export async function makeBrdfTable(module: string, file: string): Promise<void> {
    if (fs.existsSync(file) && fs.statSync(file).mtimeMs > fs.statSync(module).mtimeMs) return;
    const library = await load({module: fs.readFileSync(module)});
    const {data} = library.encode(library.brdfTable({size: k_size}), {encoding: 'rgba16f'}).levels[0]!;
    fs.writeFileSync(file, new Uint32Array(data.buffer, data.byteOffset, data.byteLength / 4).filter((_, k) => k % 2 === 0));  // without blue and alpha
}
