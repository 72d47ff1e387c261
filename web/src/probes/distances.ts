// The distances of a set of probes, as shading/probe_visibility.glsl reads them: each texel is the surface in its middle by the coordinates of the face that it is
// read from, with a border of two texels from across the edges. src/probe/distance_lookup.cpp computes the same when it is asked.

import type {CubeArray} from './cube_array';
import {faceDirection, texelAt} from './faces';
import type {Triple} from './record';

export interface Distances {
    /// Texels along a side of a face, without the border.
    size: number;
    width: number;
    height: number;
    layers: number;
    /// s, t and 1/z of the surface at z (s, t, 1) by the face's coordinates (1/z is not above 0 where it is not in front of the face), and the variance.
    texels: Float32Array;
}
export const k_border = 2;

const dot = (a: Triple, b: Triple) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Triple, b: Triple): Triple => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

export function makeDistances(array: CubeArray): Distances {
    const {size, cubes} = array, bytes = array.levels[0]!.slice().buffer;
    const moments = array.format.name === 'rg32f' ? new Float32Array(bytes) : Float32Array.from(new Float16Array(bytes));
    const across = size + 2 * k_border, width = 3 * across, height = 2 * across, texels = new Float32Array(4 * width * height * cubes);
    for (let face = 0; face < 6; ++face) {
        const axis = faceDirection(face, 0, 0), right = minus(faceDirection(face, 1, 0), axis), down = minus(faceDirection(face, 0, 1), axis);
        for (let row = -k_border; row < size + k_border; ++row)
            for (let column = -k_border; column < size + k_border; ++column) {
                const at = texelAt(size, face, (2 * column + 1) / size - 1, (2 * row + 1) / size - 1);
                const d = faceDirection(at.face, (2 * at.column + 1) / size - 1, (2 * at.row + 1) / size - 1), length = Math.hypot(...d);
                const z = dot(d, axis) / length, source = (at.face * size + at.row) * size + at.column;
                const place = (Math.floor(face / 3) * across + row + k_border) * width + (face % 3) * across + column + k_border;
                const s = dot(d, right) / length / z, t = dot(d, down) / length / z;
                for (let layer = 0; layer < cubes; ++layer) {
                    const from = 2 * (layer * 6 * size * size + source), mean = Math.max(1e-6, moments[from]!);
                    texels.set([s, t, 1 / (z * mean), Math.max(0, moments[from + 1]! - mean * mean)], 4 * (layer * width * height + place));
                }
            }
    }
    return {size, width, height, layers: cubes, texels};
}
