// Cubes as the layers of an array texture: for each level the six faces in two rows of three, each with a border of one texel from across its edges. So
// bilinear lookups have no seams, as those of src/probe/cube_store.h.

import type {CubeArray} from './cube_array';
import {texelOrAcross} from './faces';

/// Texels of RGB9E5, one word each, or of RGBA half floats, four words each.
export type AtlasTexels = Uint32Array | Uint16Array;
export interface Atlas {
    width: number;
    height: number;
    layers: number;
    texels: AtlasTexels;
    /// Of each level: texels along a side of a face, and the row of the atlas in which it begins.
    levels: {size: number; top: number}[];
}

export function rgbFromRgb9e5(bits: number): [number, number, number] {
    const scale = 2 ** ((bits >>> 27) - 24);
    return [(bits & 511) * scale, ((bits >>> 9) & 511) * scale, ((bits >>> 18) & 511) * scale];
}
/// EXT_texture_shared_exponent. r, g and b are finite and not below 0.
export function rgb9e5FromRgb(r: number, g: number, b: number): number {
    const largest = Math.min(65408, Math.max(r, g, b));
    let exponent = Math.max(-16, largest > 0 ? Math.floor(Math.log2(largest)) : -16) + 16;
    if (Math.round(largest / 2 ** (exponent - 24)) === 512) ++exponent;
    const scale = 2 ** (exponent - 24), part = (v: number) => Math.min(511, Math.round(v / scale));
    return (part(r) | (part(g) << 9) | (part(b) << 18) | (exponent << 27)) >>> 0;
}

/// How a texel is kept: so many words, and the mean of three of them (their places in words) written to a fourth.
interface Words {
    each: number;
    make: (count: number) => AtlasTexels;
    mean: (texels: AtlasTexels, to: number, from: number[]) => void;
}
const sharedExponent: Words = {
    each: 1, make: count => new Uint32Array(count),
    mean: (texels, to, from) => {
        const rgb = from.map(k => rgbFromRgb9e5(texels[k]!)), channel = (c: number) => (rgb[0]![c]! + rgb[1]![c]! + rgb[2]![c]!) / 3;
        texels[to] = rgb9e5FromRgb(channel(0), channel(1), channel(2));
    },
};
const halfFloat: Words = {
    each: 4, make: count => new Uint16Array(count),
    mean: (texels, to, from) => {
        const values = new Float16Array(texels.buffer as ArrayBuffer);
        for (let c = 0; c < 4; ++c) values[to + c] = (values[from[0]! + c]! + values[from[1]! + c]! + values[from[2]! + c]!) / 3;
    },
};

/// The words of a level of a file.
function wordsOf({format}: CubeArray, level: Uint8Array): AtlasTexels {
    const bytes = level.slice().buffer;
    if (format.name === 'rgb9e5') return new Uint32Array(bytes);
    return format.name === 'rgba32f' ? new Uint16Array(Float16Array.from(new Float32Array(bytes)).buffer) : new Uint16Array(bytes);
}

export function makeAtlas(array: CubeArray): Atlas {
    const words = array.format.name === 'rgb9e5' ? sharedExponent : halfFloat, width = 3 * (array.size + 2), levels: Atlas['levels'] = [];
    let height = 0;
    for (let l = 0; l < array.levels.length; ++l) {
        const size = Math.max(1, array.size >> l);
        levels.push({size, top: height});
        height += 2 * (size + 2);
    }
    const atlas: Atlas = {width, height, layers: array.cubes, texels: words.make(width * height * array.cubes * words.each), levels};
    array.levels.forEach((bytes, l) => placeLevel(atlas, levels[l]!, wordsOf(array, bytes), words));
    return atlas;
}

function placeLevel(atlas: Atlas, {size, top}: {size: number; top: number}, from: AtlasTexels, words: Words): void {
    const {width, height, layers, texels} = atlas, outside = (v: number) => v < 0 || v === size;
    const place = (face: number, x: number, y: number) => (top + Math.floor(face / 3) * (size + 2) + y + 1) * width + (face % 3) * (size + 2) + x + 1;
    const sources: number[] = [], places: number[] = [], corners: number[][] = [];
    for (let face = 0; face < 6; ++face)
        for (let y = -1; y <= size; ++y)
            for (let x = -1; x <= size; ++x) {
                const inX = Math.min(size - 1, Math.max(0, x)), inY = Math.min(size - 1, Math.max(0, y));
                // A corner of the border is the mean of the three texels that meet there.
                if (outside(x) && outside(y)) corners.push([place(face, x, y), place(face, inX, inY), place(face, x, inY), place(face, inX, y)]);
                else places.push(place(face, x, y)), sources.push(texelOrAcross(size, face, x, y));
            }
    for (let layer = 0; layer < layers; ++layer) {
        const base = layer * width * height, source = layer * 6 * size * size;
        for (let k = 0; k < places.length; ++k)
            for (let w = 0; w < words.each; ++w) texels[(base + places[k]!) * words.each + w] = from[(source + sources[k]!) * words.each + w]!;
        for (const [to, ...three] of corners) words.mean(texels, (base + to!) * words.each, three.map(k => (base + k) * words.each));
    }
}
