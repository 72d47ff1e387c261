// The file formats that the tests read and write themselves, so that Domelight's files are not checked by its own code.

import fs from 'node:fs';
import zlib from 'node:zlib';

/// A Radiance picture as {width, height, rgb: Float32Array of rows from the top}. Run-length coded rows and flat ones.
export function readHdr(path) {
    const bytes = fs.readFileSync(path);
    const text = bytes.toString('latin1');
    const size = /-Y (\d+) \+X (\d+)\n/.exec(text);
    const height = +size[1], width = +size[2];
    let at = size.index + size[0].length;
    const rgb = new Float32Array(width * height * 3);
    const row = new Uint8Array(width * 4);
    for (let y = 0; y < height; ++y) {
        if (bytes[at] === 2 && bytes[at + 1] === 2 && width >= 8) {
            at += 4;
            for (let c = 0; c < 4; ++c)
                for (let x = 0; x < width;) {
                    const count = bytes[at++];
                    if (count > 128) {
                        for (let k = count - 128; k > 0; --k) row[4 * x++ + c] = bytes[at];
                        ++at;
                    } else {
                        for (let k = count; k > 0; --k) row[4 * x++ + c] = bytes[at++];
                    }
                }
        } else {
            row.set(bytes.subarray(at, at + 4 * width));
            at += 4 * width;
        }
        for (let x = 0; x < width; ++x) {
            const scale = row[4 * x + 3] ? 2 ** (row[4 * x + 3] - 136) : 0;
            for (let c = 0; c < 3; ++c) rgb[3 * (y * width + x) + c] = scale * row[4 * x + c];
        }
    }
    return {width, height, rgb};
}

/// Writes a lat-long environment of one radiance, as flat Radiance rows. 1 is exact in that format.
export function writeConstantHdr(path, radiance = 1, width = 64) {
    const exponent = Math.floor(Math.log2(radiance)) + 1;
    const mantissa = Math.round(radiance * 2 ** (8 - exponent));
    const header = Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${width / 2} +X ${width}\n`);
    // Rows in runs of at most 127: some readers take only run-length coded rows.
    const run = value => Buffer.concat(Array.from({length: width / 64}, () => Buffer.from([128 + 64, value])));
    const row = Buffer.concat([Buffer.from([2, 2, width >> 8, width & 255]), run(mantissa), run(mantissa), run(mantissa), run(exponent + 128)]);
    fs.writeFileSync(path, Buffer.concat([header, ...Array(width / 2).fill(row)]));
}

/// The half float nearest to a positive number in the range of half floats.
export function toHalf(value) {
    if (value <= 0) return 0;
    const exponent = Math.max(-14, Math.floor(Math.log2(value)));
    const mantissa = Math.round(value * 2 ** (10 - exponent));
    return ((exponent + 14) << 10) + mantissa;
}

/// An unsigned float of 5 exponent bits and `bits` of mantissa, as in R11F_G11F_B10F.
function toSmallFloat(value, bits) {
    if (value <= 0) return 0;
    const exponent = Math.max(-14, Math.floor(Math.log2(value)));
    return ((exponent + 14) << bits) + Math.round(value * 2 ** (bits - exponent));
}

// Texels of one grey, in the encodings that are used here.
const greyTexel = {
    rgba16f: value => Buffer.from(Uint16Array.of(toHalf(value), toHalf(value), toHalf(value), 0x3c00).buffer),
    r11g11b10f: value => Buffer.from(Uint32Array.of((toSmallFloat(value, 6) | (toSmallFloat(value, 6) << 11) | (toSmallFloat(value, 5) << 22)) >>> 0).buffer),
};

const fillLevel = (bytes, at, length, texel) => {
    for (let k = 0; k < length; k += texel.length) texel.copy(bytes, at + k);
};

/// The positions of the levels in a cube's file: [{level, ranges: [[offset, length], ...]}], with its texels' encoding.
function cubeLevels(bytes) {
    const u32 = at => bytes.readUInt32LE(at);
    const levels = [];
    if (bytes.subarray(1, 7).toString() === 'KTX 20') {
        if (u32(12) !== 97 || u32(44) !== 0) throw new Error('repaint: only RGBA16F without supercompression');
        for (let level = 0; level < u32(40); ++level) {
            const index = 80 + 24 * level;
            levels.push([[Number(bytes.readBigUInt64LE(index)), Number(bytes.readBigUInt64LE(index + 8))]]);
        }
        return {encoding: 'rgba16f', levels};
    }
    if (bytes.subarray(1, 7).toString() === 'KTX 11') {
        if (u32(28) !== 0x8c3a) throw new Error('repaint: only R11F_G11F_B10F');
        let at = 64 + u32(60);
        for (let level = 0; level < u32(56); ++level) {
            const length = u32(at);
            levels.push([[at + 4, 6 * length]]);  // faces are whole words, so nothing pads them
            at += 4 + 6 * length;
        }
        return {encoding: 'r11g11b10f', levels};
    }
    if (bytes.subarray(0, 4).toString() === 'DDS ') {
        const size = u32(12), count = u32(28), dx10 = bytes.subarray(84, 88).toString() === 'DX10';
        if (dx10 ? u32(128) !== 10 : u32(84) !== 113) throw new Error('repaint: only RGBA16F');
        const start = dx10 ? 148 : 128;
        const lengths = Array.from({length: count}, (_, level) => 8 * Math.max(1, size >> level) ** 2);
        const face = lengths.reduce((sum, length) => sum + length, 0);
        for (let level = 0, within = 0; level < count; within += lengths[level++])
            levels.push(Array.from({length: 6}, (_, k) => [start + k * face + within, lengths[level]]));
        return {encoding: 'rgba16f', levels};
    }
    throw new Error('repaint: not a container that is known here');
}

/// Copies a KTX2 without supercompression with each level's bytes replaced by bytes(level, length), a Buffer of that length.
export function replaceLevels(from, to, bytes) {
    const file = Buffer.from(fs.readFileSync(from));
    if (file.readUInt32LE(44) !== 0) throw new Error('replaceLevels: supercompressed');
    for (let level = 0; level < file.readUInt32LE(40); ++level) {
        const [at, length] = [0, 8].map(k => Number(file.readBigUInt64LE(80 + 24 * level + k)));
        bytes(level, length).copy(file, at);
    }
    fs.writeFileSync(to, file);
}

/// Copies a cube with every texel of level l replaced by value(l, count), and returns those values as they are stored.
export function repaintLevels(from, to, value) {
    const bytes = Buffer.from(fs.readFileSync(from));
    const {encoding, levels} = cubeLevels(bytes);
    const values = levels.map((_, level) => value(level, levels.length));
    levels.forEach((ranges, level) => {
        for (const [at, length] of ranges) fillLevel(bytes, at, length, greyTexel[encoding](values[level]));
    });
    fs.writeFileSync(to, bytes);
    return values;
}

// KTX2 with UASTC HDR 4x4, as three.js and other users of Basis Universal load it.

/// A block whose 16 texels are one grey: ASTC's HDR void extent.
function uastcHdrGrey(value) {
    const half = toHalf(value);
    const block = Buffer.alloc(16, 0xff);
    block[0] = 0xfc;
    [half, half, half, 0x3c00].forEach((v, k) => block.writeUInt16LE(v, 8 + 2 * k));
    return block;
}

/// Copies a UASTC HDR cube with each level a constant (without supercompression), or makes one from nothing where `from` is null.
export function repaintUastcHdr(from, to, value, {size = 64, count = 5} = {}) {
    let descriptor = Buffer.from(Uint32Array.of(44, 0, (40 << 16) | 2, 0x000101a7, 0x00000303, 16, 0, 127 << 16, 0, 0, 0xffffffff).buffer);
    let keys = Buffer.alloc(0);
    if (from) {
        const bytes = fs.readFileSync(from);
        size = bytes.readUInt32LE(20);
        count = bytes.readUInt32LE(40);
        const part = at => bytes.subarray(bytes.readUInt32LE(at), bytes.readUInt32LE(at) + bytes.readUInt32LE(at + 4));
        descriptor = part(48);
        keys = part(56);
    }
    const values = Array.from({length: count}, (_, level) => value(level, count));
    const lengths = values.map((_, level) => 6 * 16 * Math.max(1, size >> (level + 2)) ** 2);
    const header = Buffer.alloc(80 + 24 * count);
    Buffer.from([0xab, ...Buffer.from('KTX 20'), 0xbb, 13, 10, 26, 10]).copy(header);
    const afterHeader = header.length + descriptor.length;
    [1000066000, 1, size, size, 0, 0, 6, count, 0, header.length, descriptor.length, keys.length ? afterHeader : 0, keys.length]
        .forEach((word, k) => header.writeUInt32LE(word, 12 + 4 * k));
    let at = Math.ceil((afterHeader + keys.length) / 16) * 16;
    const parts = [header, descriptor, keys, Buffer.alloc(at - afterHeader - keys.length)];
    for (let level = count - 1; level >= 0; --level) {
        [at, lengths[level], lengths[level]].forEach((v, k) => header.writeBigUInt64LE(BigInt(v), 80 + 24 * level + 8 * k));
        parts.push(Buffer.alloc(lengths[level], uastcHdrGrey(values[level])));
        at += lengths[level];
    }
    fs.writeFileSync(to, Buffer.concat(parts));
    return values;
}

/// A .glb of a glTF document and its one buffer.
export function glb(document, binary) {
    const pad = (buffer, fill) => Buffer.concat([buffer, Buffer.alloc((4 - buffer.length % 4) % 4, fill)]);
    const bytes = pad(binary, 0), json = pad(Buffer.from(JSON.stringify({...document, buffers: [{byteLength: bytes.length}]})), 0x20);
    const words = (...numbers) => Buffer.from(Uint32Array.from(numbers).buffer);
    return Buffer.concat([words(0x46546c67, 2, 28 + json.length + bytes.length), words(json.length, 0x4e4f534a), json, words(bytes.length, 0x004e4942), bytes]);
}

/// A value of linear light as a screen shows it: sRGB's curve, between 0 and 1.
export const onScreen = v => (v <= 0.0031308 ? 12.92 * Math.max(0, v) : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055);

// PNG, for pictures that people look at.

/// An 8-bit PNG of RGB or RGBA rows from the top.
export function png(width, height, pixels, channels = 3) {
    const table = Array.from({length: 256}, (_, n) => Array.from({length: 8}).reduce(c => (c >>> 1) ^ (c & 1 ? 0xedb88320 : 0), n));
    const crc = bytes => ~bytes.reduce((c, v) => table[(c ^ v) & 255] ^ (c >>> 8), ~0);
    const chunk = (name, data) => {
        const body = Buffer.concat([Buffer.from(name), data]), ends = Buffer.alloc(8);
        ends.writeUInt32BE(data.length, 0);
        ends.writeInt32BE(crc(body), 4);
        return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
    };
    const header = Buffer.alloc(13);
    header.writeUInt32BE(width, 0);
    header.writeUInt32BE(height, 4);
    header.set([8, channels === 4 ? 6 : 2], 8);
    // Each row is stored as its differences from Paeth's prediction, filter 4.
    const stride = channels * width, rows = Buffer.alloc(height * (stride + 1), 4);
    const at = (x, y) => (x < 0 || y < 0 ? 0 : pixels[y * stride + x]);
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < stride; ++x) {
            const a = at(x - channels, y), b = at(x, y - 1), c = at(x - channels, y - 1), p = a + b - c;
            const da = Math.abs(p - a), db = Math.abs(p - b), dc = Math.abs(p - c);
            rows[y * (stride + 1) + 1 + x] = at(x, y) - (da <= db && da <= dc ? a : db <= dc ? b : c);
        }
    return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', header), chunk('IDAT', zlib.deflateSync(rows, {level: 9})),
                          chunk('IEND', Buffer.alloc(0))]);
}

export const writePng = (path, width, height, rgb) => fs.writeFileSync(path, png(width, height, rgb));

// PlayCanvas' atlas: 512^2 texels of RGBP, (rgb (8 - 7 a))^2.

/// Writes an atlas whose rectangles show radiance(direction, k): k = 0 the sharp pictures, 1 to 6 the rough ones, 'ambient'.
export function writeAtlas(path, radiance) {
    const rgba = Buffer.alloc(4 * 512 * 512);
    const fill = (x, y, width, height, k) => {
        for (let j = 0; j < height; ++j)
            for (let i = 0; i < width; ++i) {
                // The outermost texels repeat their neighbours' directions: the picture begins half a texel further in.
                const phi = ((i - 0.5) / Math.max(1, width - 2) - 0.5) * 2 * Math.PI;
                const theta = Math.min(1, Math.max(0, (j - 0.5) / Math.max(1, height - 2))) * Math.PI;
                const root = radiance([-Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)], k).map(Math.sqrt);
                const a = Math.floor(255 * Math.min(1, Math.max(0, (8 - Math.max(1, ...root)) / 7))) / 255;
                rgba.set([...root.map(v => Math.round(255 * Math.min(1, v / (8 - 7 * a)))), Math.round(255 * a)], 4 * ((y + j) * 512 + x + i));
            }
    };
    for (let k = 0; k < 6; ++k) fill(512 - (512 >> k), 512 - (512 >> k), 512 >> k, 256 >> k, 0);
    for (let k = 1; k < 7; ++k) fill(0, 512 - (512 >> k), 512 >> k, 256 >> k, k);
    fill(128, 384, 64, 32, 'ambient');
    fs.writeFileSync(path, png(512, 512, rgba, 4));
}

/// An atlas whose levels 0 to 5, roughness 0 to 1, are one grey each.
export function repaintAtlas(from, to, value) {
    const values = Array.from({length: 6}, (_, level) => value(level, 6));
    writeAtlas(to, (_, k) => Array(3).fill(values[k === 'ambient' ? 5 : Math.min(5, k)]));
    return values;
}

/// Copies a Babylon .env (magic, JSON that ends with a zero byte, PNG images of RGBD) with each level of one grey.
export function repaintEnv(from, to, value) {
    const bytes = fs.readFileSync(from), end = bytes.indexOf(0, 8), document = JSON.parse(bytes.subarray(8, end));
    const count = document.specular.mipmaps.length / 6, images = [];
    // RGBD with D = 1 is the gamma-coded colour itself.
    const coded = Array.from({length: count}, (_, level) => Math.round(255 * value(level, count) ** (1 / 2.2)));
    let position = 0;
    document.imageType = 'image/png';
    document.specular.mipmaps = coded.flatMap((code, level) => {
        const size = document.width >> level, image = png(size, size, Buffer.alloc(4 * size * size, Buffer.from([code, code, code, 255])), 4);
        return Array.from({length: 6}, () => {
            images.push(image);
            position += image.length;
            return {length: image.length, position: position - image.length};
        });
    });
    delete document.irradiance?.irradianceTexture;
    fs.writeFileSync(to, Buffer.concat([bytes.subarray(0, 8), Buffer.from(`${JSON.stringify(document)}\0`), ...images]));
    return coded.map(code => (code / 255) ** 2.2);
}
