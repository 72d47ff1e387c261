// Radiance HDR: the pixels as floats. Ward 1991, "Real pixels"; the file format of radsite's filefmts.

import type {Latlong} from './types';

const k_most_pixels = 2 ** 27;

/// Throws an Error whose message is the end of a sentence about the file.
export function readHdr(bytes: Uint8Array): Latlong {
    const text = new TextDecoder('latin1').decode(bytes.subarray(0, 4096)), header = /\n\n(-Y) (\d+) (\+X) (\d+)\n/.exec(text);
    if (!header) throw new Error('the header has no line such as "-Y 512 +X 1024"');
    if (!/^FORMAT=32-bit_rle_rgbe$/m.test(text.slice(0, header.index))) throw new Error('the pixels are not in the format 32-bit_rle_rgbe');
    const height = Number(header[2]), width = Number(header[4]);
    if (width * height > k_most_pixels) throw new Error(`${width} x ${height} pixels are more than this page can hold`);
    const pixels = new Float32Array(3 * width * height), row = new Uint8Array(4 * width), reader = new RowReader(bytes, header.index + header[0].length);
    for (let y = 0; y < height; ++y) {
        reader.read(row, width);
        for (let x = 0, to = 3 * y * width; x < width; ++x, to += 3) {
            // m / 256 2^(e - 128), as the library reads it.
            const e = row[3 * width + x]!, scale = e > 0 ? 2 ** (e - 136) : 0;
            pixels[to] = row[x]! * scale;
            pixels[to + 1] = row[width + x]! * scale;
            pixels[to + 2] = row[2 * width + x]! * scale;
        }
    }
    return {width, height, pixels};
}

/// Rows as four planes: R, G, B and the exponents.
class RowReader {
    constructor(
        private readonly bytes: Uint8Array,
        private at: number,
    ) {}

    read(row: Uint8Array, width: number): void {
        const {bytes, at} = this;
        const run = bytes[at] === 2 && bytes[at + 1] === 2 && bytes[at + 2]! < 128;
        if (!run) return this.plain(row, width);
        if (((bytes[at + 2]! << 8) | bytes[at + 3]!) !== width) throw new Error('a row has another length than the header says');
        this.at += 4;
        for (let plane = 0; plane < 4; ++plane) this.plane(row.subarray(plane * width, (plane + 1) * width));
    }
    private plane(out: Uint8Array): void {
        for (let x = 0; x < out.length; ) {
            const code = this.next(), count = code > 128 ? code - 128 : code;
            if (count === 0 || x + count > out.length) throw new Error('a run is longer than its row');
            if (code > 128) out.fill(this.next(), x, x + count);
            else for (let k = 0; k < count; ++k) out[x + k] = this.next();
            x += count;
        }
    }
    private plain(row: Uint8Array, width: number): void {
        for (let x = 0; x < width; ++x) for (let plane = 0; plane < 4; ++plane) row[plane * width + x] = this.next();
    }
    private next(): number {
        if (this.at >= this.bytes.length) throw new Error('it ends before its last row');
        return this.bytes[this.at++]!;
    }
}
