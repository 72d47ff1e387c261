// The KTX2 cube arrays of a set of probes: no supercompression; in a level the cubes lie one after the other, each with its six faces.

const identifier = [0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
/// Formats by their numbers in Vulkan.
const formats = {
    123: {name: 'rgb9e5', channels: 3, bytes: 4}, 97: {name: 'rgba16f', channels: 3, bytes: 8}, 109: {name: 'rgba32f', channels: 3, bytes: 16},
    83: {name: 'rg16f', channels: 2, bytes: 4}, 103: {name: 'rg32f', channels: 2, bytes: 8},
} as const;
export type TexelFormat = (typeof formats)[keyof typeof formats];

export interface CubeArray {
    format: TexelFormat;
    size: number;
    cubes: number;
    /// The bytes of each level.
    levels: Uint8Array[];
}
/// What probes.json says of a file.
export interface Expected {
    size: number;
    cubes: number;
    levels: number;
    /// 3: light. 2: moments of distances.
    channels: 2 | 3;
}

/// Throws a sentence that says what is wrong with the file.
export function readCubeArray(name: string, bytes: ArrayBuffer, expected: Expected): CubeArray {
    const wrong = (what: string) => new Error(`${name}: ${what}.`), view = new DataView(bytes);
    if (bytes.byteLength < 80 || identifier.some((v, k) => view.getUint8(k) !== v)) throw wrong('it is no KTX2 file');
    const [number, , width, , , layers, faces, levelCount, supercompression] = Array.from({length: 9}, (_, k) => view.getUint32(12 + 4 * k, true)) as [number, number, number, number, number, number, number, number, number];
    const format = formats[number as keyof typeof formats];
    if (!format || supercompression !== 0) throw wrong('its texels are none of RGB9E5, RGBA16F, RGBA32F, RG16F and RG32F without supercompression');
    const cubes = Math.max(1, layers);
    if (faces !== 6 || width !== expected.size || cubes !== expected.cubes || levelCount !== expected.levels || format.channels !== expected.channels)
        throw wrong(`it holds ${cubes} cubes of ${faces} faces, ${width} texels a face, ${levelCount} levels and ${format.channels} channels, but probes.json says ${expected.cubes}, 6, ${expected.size}, ${expected.levels} and ${expected.channels}`);
    const levels = Array.from({length: levelCount}, (_, l) => {
        const at = 80 + 24 * l, side = Math.max(1, width >> l), needed = cubes * 6 * side * side * format.bytes;
        if (at + 24 > bytes.byteLength) throw wrong('it ends within its header');
        const offset = Number(view.getBigUint64(at, true)), length = Number(view.getBigUint64(at + 8, true));
        if (length !== needed) throw wrong(`level ${l} has ${length} bytes and needs ${needed}`);
        if (offset + length > bytes.byteLength) throw wrong(`it ends within level ${l}`);
        return new Uint8Array(bytes, offset, length);
    });
    return {format, size: width, cubes, levels};
}
