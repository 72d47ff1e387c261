// Environments as lat-long maps that lie as the page's world does: what is shown, and what light directions are drawn from. The filters read the environment itself.

import type {Environment} from './module';
import type {CubeLevel, Latlong} from './types';

const k_largest_face = 1024;

/// A lat-long file as it is, or turned into the world; of any other projection what a cube of its light shows.
export function asLatlong(environment: Environment): Latlong {
    const {projection, worldToSource, latlongHeight} = environment.info;
    if (projection === 'latlong') {
        const stored = environment.latlong();
        return worldToSource.every((v, k) => v === (k % 4 === 0 ? 1 : 0)) ? stored : lookedUp(stored.height, turned(worldToSource, lookupOf(stored)));
    }
    const size = Math.min(k_largest_face, 2 ** Math.ceil(Math.log2(latlongHeight / 2)));
    return lookedUp(2 * size, cubeLookup(environment.cube(size)));
}

/// Writes the light from direction (x, y, z) to out[at ...].
type Lookup = (x: number, y: number, z: number, out: Float32Array, at: number) => void;

function lookedUp(height: number, lookup: Lookup): Latlong {
    const width = 2 * height, pixels = new Float32Array(3 * width * height);
    for (let j = 0, at = 0; j < height; ++j) {
        const theta = ((j + 0.5) / height) * Math.PI, s = Math.sin(theta), y = Math.cos(theta);
        for (let i = 0; i < width; ++i, at += 3) {
            const phi = ((i + 0.5) / width - 0.5) * 2 * Math.PI;
            lookup(s * Math.cos(phi), y, s * Math.sin(phi), pixels, at);
        }
    }
    return {width, height, pixels};
}

const turned = (m: number[], lookup: Lookup): Lookup => (x, y, z, out, at) =>
    lookup(m[0]! * x + m[1]! * y + m[2]! * z, m[3]! * x + m[4]! * y + m[5]! * z, m[6]! * x + m[7]! * y + m[8]! * z, out, at);

/// Bilinear between texels; repeats in u.
function lookupOf({width, height, pixels}: Latlong): Lookup {
    return (x, y, z, out, at) => {
        const px = (0.5 + Math.atan2(z, x) / (2 * Math.PI)) * width - 0.5, py = (Math.acos(Math.min(1, Math.max(-1, y))) / Math.PI) * height - 0.5;
        const i = Math.floor(px), j = Math.floor(py), s = px - i, t = py - j;
        const i0 = (i + width) % width, i1 = (i + 1) % width, j0 = Math.max(0, j) * width, j1 = Math.min(height - 1, j + 1) * width;
        mix(out, at, pixels, 3 * (j0 + i0), 3 * (j0 + i1), 3 * (j1 + i0), 3 * (j1 + i1), s, t);
    };
}

/// Bilinear within each face.
function cubeLookup({size, texels}: CubeLevel): Lookup {
    const halves = new Float16Array(texels.buffer, texels.byteOffset, texels.length);
    return (x, y, z, out, at) => {
        const ax = Math.abs(x), ay = Math.abs(y), az = Math.abs(z), most = Math.max(ax, ay, az);
        const face = ax === most ? (x > 0 ? 0 : 1) : ay === most ? (y > 0 ? 2 : 3) : z > 0 ? 4 : 5;
        const u = face === 0 ? -z : face === 1 ? z : face === 5 ? -x : x, v = face === 2 ? z : face === 3 ? -z : -y;
        const px = Math.min(size - 1, Math.max(0, (0.5 + (0.5 * u) / most) * size - 0.5)), py = Math.min(size - 1, Math.max(0, (0.5 + (0.5 * v) / most) * size - 0.5));
        const i = Math.min(size - 2, Math.floor(px)), j = Math.min(size - 2, Math.floor(py)), from = 4 * ((face * size + j) * size + i);
        mix(out, at, halves, from, from + 4, from + 4 * size, from + 4 * size + 4, px - i, py - j);
    };
}

function mix(out: Float32Array, at: number, from: ArrayLike<number>, a: number, b: number, c: number, d: number, s: number, t: number): void {
    for (let k = 0; k < 3; ++k) {
        const above = from[a + k]! + s * (from[b + k]! - from[a + k]!), below = from[c + k]! + s * (from[d + k]! - from[c + k]!);
        out[at + k] = above + t * (below - above);
    }
}

/// What was drawn in the scene, before the environment: RGB of six faces. drawn: RGBA, in which rows and columns are in reverse order.
export function overEnvironment(size: number, drawn: Float32Array, {texels}: CubeLevel): Float32Array {
    const light = new Float16Array(texels.buffer, texels.byteOffset, texels.length), out = new Float32Array(18 * size * size), area = size * size;
    for (let face = 0, to = 0; face < 6; ++face)
        for (let k = 0; k < area; ++k, to += 3) {
            const from = 4 * (face * area + area - 1 - k), behind = 4 * (face * area + k), open = 1 - drawn[from + 3]!;
            for (let c = 0; c < 3; ++c) out[to + c] = Math.max(0, drawn[from + c]! + open * light[behind + c]!);
        }
    return out;
}

/// RGBA half floats; brighter light than they hold has their largest value.
export function halfFloats({width, height, pixels}: Latlong): Uint16Array {
    const texels = new Float16Array(4 * width * height);
    for (let k = 0, from = 0; k < texels.length; ++from) {
        texels[k++] = Math.min(65504, pixels[from]!);
        texels[k++] = Math.min(65504, pixels[++from]!);
        texels[k++] = Math.min(65504, pixels[++from]!);
        texels[k++] = 1;
    }
    return new Uint16Array(texels.buffer);
}
