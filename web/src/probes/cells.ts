// Tetrahedra as the texels that shading/probe_cells.glsl reads.

import {type ProbeRecord, type Triple} from './record';
import {cross, orientation, Tetrahedra} from './tetrahedra';

/// RGBA floats, rows of k_cells_width texels.
export interface CellTexels {
    height: number;
    /// 1: of the probes that count. 2: then of all of them, also those that are not valid.
    layers: number;
    texels: Float32Array;
}
export const k_cells_width = 1024;

/// Of a set whose places are no grid; null for a grid.
export function makeCells({grid, probes}: ProbeRecord): CellTexels | null {
    if (grid) return null;
    const all = probes.map((_, k) => k), valid = all.filter(k => probes[k]!.valid);
    const layers = [valid.length > 0 ? valid : all, ...(valid.length > 0 && valid.length < all.length ? [all] : [])].map(numbers => pack(numbers, new Tetrahedra(numbers.map(k => probes[k]!.position))));
    const height = Math.ceil(Math.max(...layers.map(({length}) => length)) / 4 / k_cells_width), texels = new Float32Array(4 * k_cells_width * height * layers.length);
    layers.forEach((values, layer) => texels.set(values, 4 * k_cells_width * height * layer));
    return {height, layers: layers.length, texels};
}

/// numbers: of the probes between which the tetrahedra are.
///
/// Texels 0 to 6: the centre of the frame, with the number of cells; its axes, with the numbers of the first texel of the boxes and of the hull, and of the hull's faces; where
/// the boxes begin, with the number of the points; their size; how many there are on each axis. Then five for each cell: vertex 0; the gradients of the weights of vertices 1 to
/// 3, each with the cell across the face opposite to its vertex (-1: there is none); and whose the vertices are. Then one for each box: the cell from which to walk. Then three for
/// each face of the hull: its corners.
function pack(numbers: number[], tetrahedra: Tetrahedra): number[] {
    const {rank, centre, axes, position, point, bins, binOrigin, binSize} = tetrahedra, k_header = 7;
    const real = tetrahedra.cells.flatMap((cell, t) => (tetrahedra.isGhost(cell) ? [] : [t])), place = new Map(real.map((t, k) => [t, k]));
    const cellOf = (t: number) => place.get(t) ?? -1, probe = (v: number) => numbers[point[v]!]!;
    const boxes = k_header + 5 * real.length, hull = boxes + tetrahedra.start.length, out: number[] = [], ghosts = tetrahedra.cells.filter(cell => tetrahedra.isGhost(cell));
    const put = (v: Triple, w: number) => out.push(...v, w);
    put(centre, real.length);
    [boxes, hull, ghosts.length].forEach((w, k) => put(axes[k]!, w));
    put(binOrigin, numbers.length);
    put(binSize, rank === 0 ? numbers[0]! : 0);
    put(bins, 0);
    for (const t of real) {
        const cell = tetrahedra.cells[t]!, corner = cell.vertex.map(v => position[v]!) as [Triple, Triple, Triple, Triple], volume = orientation(...corner);
        put(corner[0], cellOf(cell.neighbour[0]));
        for (let f = 1; f < 4; ++f) {
            const [a, b, c] = tetrahedra.facePositions(cell, f), normal = cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
            put(normal.map(v => v / volume) as Triple, cellOf(cell.neighbour[f]!));
        }
        out.push(...cell.vertex.map(probe));
    }
    for (const t of tetrahedra.start) out.push(cellOf(t), 0, 0, 0);
    for (const ghost of ghosts) for (const p of tetrahedra.facePositions(ghost, ghost.vertex.indexOf(-1))) put(p, 0);
    return out;
}
