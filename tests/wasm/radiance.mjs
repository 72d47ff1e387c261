import fs from 'node:fs';

/// A Radiance picture, decoded without our code: new run-length encoding.
export function readHdr(file) {
    const bytes = fs.readFileSync(file), size = /-Y (\d+) \+X (\d+)\n/.exec(bytes.toString('latin1'));
    const height = +size[1], width = +size[2], pixels = new Float32Array(3 * width * height), row = new Uint8Array(4 * width);
    let at = size.index + size[0].length;
    for (let y = 0; y < height; ++y) {
        at += 4;
        for (let c = 0; c < 4; ++c)
            for (let x = 0; x < width;) {
                const count = bytes[at++];
                if (count > 128) {
                    for (let k = count - 128; k > 0; --k) row[4 * x++ + c] = bytes[at];
                    ++at;
                } else for (let k = count; k > 0; --k) row[4 * x++ + c] = bytes[at++];
            }
        for (let x = 0; x < width; ++x)
            for (let c = 0; c < 3; ++c) pixels[3 * (y * width + x) + c] = row[4 * x + 3] ? row[4 * x + c] * 2 ** (row[4 * x + 3] - 136) : 0;
    }
    return {data: pixels, width, height};
}
