import fs from 'node:fs';

/// The levels of an uncompressed KTX2 of RGBA floats, as RGB.
export function readKtx2(file) {
    const bytes = fs.readFileSync(file), width = bytes.readUInt32LE(20), levels = bytes.readUInt32LE(40);
    return Array.from({length: levels}, (_, l) => {
        const offset = Number(bytes.readBigUInt64LE(80 + 24 * l)), length = Number(bytes.readBigUInt64LE(88 + 24 * l));
        const rgba = new Float32Array(bytes.buffer.slice(bytes.byteOffset + offset, bytes.byteOffset + offset + length));
        return {width: width >> l, data: rgba.filter((_, k) => k % 4 !== 3)};
    });
}

/// RMS of the differences, relative to that of the expected values.
export function relativeRms(data, expected) {
    let off = 0, all = 0;
    data.forEach((v, k) => { off += (v - expected[k]) ** 2; all += expected[k] ** 2; });
    return Math.sqrt(off / all);
}
