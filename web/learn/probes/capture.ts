// The probes of the page's rooms as a set, like those that `domelight probes` writes.

import type {Tables} from '../../src/bake/types';
import type {CubeArray, TexelFormat} from '../../src/probes/cube_array';
import {makeAtlas} from '../../src/probes/atlas';
import {makeDistances} from '../../src/probes/distances';
import {faceDirection} from '../../src/probes/faces';
import type {ProbeSet} from '../../src/probes/load';
import type {Grid, Probe, Triple} from '../../src/probes/record';

export const rooms: Triple = [6, 2.4, 3];
export const k_half_wall = 0.1;
export const k_size = 16;
const k_irradiance_size = 8;
/// A probe to each metre, half a metre from the walls.
export const grid: Grid = {origin: [0.5, 0.7, 0.5], spacing: [1, 1, 1], counts: [6, 2, 3]};
export const k_probes = 36;

/// Where the probes stand, each with the walls of its room. wall: x of the middle of the wall between the rooms.
export function placedProbes(wall: number): Probe[] {
    return Array.from({length: k_probes}, (_, k) => {
        const [nx, ny] = grid.counts, column = [k % nx, Math.floor(k / nx) % ny, Math.floor(k / nx / ny)];
        const position = column.map((n, axis) => grid.origin[axis]! + n * grid.spacing[axis]!) as Triple, bright = position[0] < wall;
        return {
            position, valid: Math.abs(position[0] - wall) >= k_half_wall, moved: false, influence: {shape: 'everywhere', radius: 0, fade: 0}, harmonics: Array.from({length: 9}, (): Triple => [0, 0, 0]),
            proxy: {low: [bright ? 0 : wall + k_half_wall, 0, 0], high: [bright ? wall - k_half_wall : rooms[0], rooms[1], rooms[2]]},
        };
    });
}

const rgba: TexelFormat = {name: 'rgba32f', channels: 3, bytes: 16}, rg: TexelFormat = {name: 'rg32f', channels: 2, bytes: 8};
const arrayOf = (format: TexelFormat, size: number, values: Float32Array): CubeArray => ({format, size, cubes: k_probes, levels: [new Uint8Array(values.buffer)]});

/// A set of what was captured: RGBA and moments (in the first two of four channels) of k_size texels a face.
/// irradiance: of irradianceOverPi(), likewise.
export function setOf(probes: Probe[], radiance: Float32Array, moments: Float32Array, irradiance: Float32Array): ProbeSet {
    const distances = Float32Array.from({length: moments.length / 2}, (_, k) => moments[4 * (k >> 1) + (k & 1)]!);
    return {
        record: {
            scene: '', bounces: 0, grid, probes, roughness: [0], specular: {file: '', size: k_size}, irradiance: {file: '', size: k_irradiance_size}, distance: {file: '', size: k_size},
        },
        maps: {
            specular: makeAtlas(arrayOf(rgba, k_size, radiance)), irradiance: makeAtlas(arrayOf(rgba, k_irradiance_size, irradiance)),
            distances: makeDistances(arrayOf(rg, k_size, distances)), cells: null,
        },
    };
}

/// The light that frosted glass in a wall towards -X spreads to all sides: the environment's mean over that half, weighted by the cosine, times a factor.
export function windowLight({width, height, texels}: Tables, factor: number): Triple {
    const sum: Triple = [0, 0, 0];
    let total = 0;
    for (let y = 0; y < height; ++y) {
        const sine = Math.sin((Math.PI * (y + 0.5)) / height);
        for (let x = 0; x < width; ++x) {
            const weight = sine * sine * -Math.cos((2 * Math.PI * (x + 0.5)) / width - Math.PI);
            if (weight <= 0) continue;
            total += weight;
            for (let c = 0; c < 3; ++c) sum[c]! += weight * texels[4 * (y * width + x) + c]!;
        }
    }
    return sum.map(v => (factor * v) / total) as Triple;
}

/// Unit directions of the texels of a cube, and the part of the sphere that each covers.
function texelsOf(size: number): {directions: Triple[]; parts: number[]} {
    const directions: Triple[] = [], parts: number[] = [];
    for (let face = 0; face < 6; ++face)
        for (let row = 0; row < size; ++row)
            for (let column = 0; column < size; ++column) {
                const d = faceDirection(face, (2 * column + 1) / size - 1, (2 * row + 1) / size - 1), length = Math.hypot(...d);
                directions.push([d[0] / length, d[1] / length, d[2] / length]);
                parts.push(1 / length ** 3);
            }
    return {directions, parts};
}

/// Of each texel of the irradiance: the mean of the light about its normal, weighted by the cosine, as a sum over all texels that were captured. pause: lets the page do other things
/// now and then.
export async function irradianceOverPi(radiance: Float32Array, pause: () => Promise<void>): Promise<Float32Array> {
    const from = texelsOf(k_size), to = texelsOf(k_irradiance_size), texels = from.parts.length, out = new Float32Array(4 * k_probes * to.parts.length).fill(1);
    for (const [t, n] of to.directions.entries()) {
        if (t % 8 === 7) await pause();
        const weights = from.directions.map((d, k) => Math.max(0, n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) * from.parts[k]!), total = weights.reduce((a, b) => a + b);
        const seen = weights.flatMap((w, k) => (w > 0 ? [k] : []));
        for (let probe = 0; probe < k_probes; ++probe) {
            let r = 0, g = 0, b = 0;
            for (const k of seen) {
                const at = 4 * (probe * texels + k), w = weights[k]!;
                r += w * radiance[at]!;
                g += w * radiance[at + 1]!;
                b += w * radiance[at + 2]!;
            }
            out.set([r / total, g / total, b / total], 4 * (probe * to.parts.length + t));
        }
    }
    return out;
}
