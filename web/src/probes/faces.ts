// The faces of a cube as docs/conventions.md has them, and what lies beyond their edges. The C++ is src/projection/bordered_cube.cpp.

import type {Triple} from './record';

/// The direction at (s, t) of a face, both from -1 to 1 with s to the right and t down. Not of unit length: 1 along the face's axis.
export function faceDirection(face: number, s: number, t: number): Triple {
    return ([[1, -t, -s], [-1, -t, s], [s, 1, t], [s, -1, -t], [s, -t, 1], [-s, -t, -1]] as Triple[])[face]!;
}

/// The face in a direction, with s and t.
export function facePoint([x, y, z]: Triple): {face: number; s: number; t: number} {
    const ax = Math.abs(x), ay = Math.abs(y), az = Math.abs(z);
    if (ax >= ay && ax >= az) return x > 0 ? {face: 0, s: -z / ax, t: -y / ax} : {face: 1, s: z / ax, t: -y / ax};
    if (ay >= az) return y > 0 ? {face: 2, s: x / ay, t: z / ay} : {face: 3, s: x / ay, t: -z / ay};
    return z > 0 ? {face: 4, s: x / az, t: -y / az} : {face: 5, s: -x / az, t: -y / az};
}

/// A texel of a cube that is seen in the direction of (s, t) of a face, which may lie beyond its edges.
export function texelAt(size: number, face: number, s: number, t: number): {face: number; column: number; row: number} {
    const point = facePoint(faceDirection(face, s, t)), index = (v: number) => Math.min(size - 1, Math.max(0, Math.floor(((v + 1) / 2) * size)));
    return {face: point.face, column: index(point.s), row: index(point.t)};
}

/// The number of the texel in column x and row y of a face, in the order of a file; just beyond an edge it is the one across that edge.
export function texelOrAcross(size: number, face: number, x: number, y: number): number {
    // A point a thousandth of a step beyond the edge already belongs to the neighbour.
    const coordinate = (i: number) => 2 * Math.min(1 + 1e-3 / size, Math.max(-1e-3 / size, (i + 0.5) / size)) - 1;
    if (x >= 0 && y >= 0 && x < size && y < size) return (face * size + y) * size + x;
    const {face: other, column, row} = texelAt(size, face, coordinate(x), coordinate(y));
    return (other * size + row) * size + column;
}
