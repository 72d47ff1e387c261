// Delaunay tetrahedra between the probes of a set: a port of src/probe/tetrahedra.cpp, whose header (include/domelight/probe/tetrahedra.h) says what is done and why.
// The light outside of the probes' hull depends on its copies of the outermost probes, which probes.json does not hold.

import type {Triple} from './record';

type Four = [number, number, number, number];
interface Cell {
    /// Positive orientation; k_ghost: the ghost vertex at infinity.
    vertex: Four;
    /// Across the face opposite to that vertex.
    neighbour: Four;
    removed: boolean;
}

const k_ghost = -1;
/// The corners of the face opposite to each vertex, in an order that makes (face, vertex) a positive tetrahedron.
const k_face = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]] as const;

const minus = (a: Triple, b: Triple): Triple => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Triple, b: Triple): Triple => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const distance = (a: Triple, b: Triple): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/// Six times the signed volume: positive if d lies on the side from which a, b, c run clockwise.
export const orientation = (a: Triple, b: Triple, c: Triple, d: Triple): number => dot(cross(minus(b, a), minus(c, a)), minus(d, a));

/// mix_bits() of include/domelight/base/random.h.
function mixBits(x: bigint): bigint {
    x = BigInt.asUintN(64, x + 0x9e3779b97f4a7c15n);
    x = BigInt.asUintN(64, (x ^ (x >> 30n)) * 0xbf58476d1ce4e5b9n);
    x = BigInt.asUintN(64, (x ^ (x >> 27n)) * 0x94d049bb133111ebn);
    return x ^ (x >> 31n);
}
/// A number from -1 to 1 that depends on nothing but its arguments.
const jitter = (vertex: number, axis: number): number => Number(mixBits(BigInt.asUintN(64, mixBits(BigInt(vertex)) + BigInt(axis))) >> 11n) * 2 ** -52 - 1;

/// The eigenvectors of a symmetric matrix, by Jacobi's rotations.
function principalAxes(m: number[][]): Triple[] {
    const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    for (let sweep = 0; sweep < 30; ++sweep)
        for (const [p, q] of [[0, 1], [0, 2], [1, 2]] as const) {
            if (m[p]![q] === 0) continue;
            const angle = 0.5 * Math.atan2(2 * m[p]![q]!, m[q]![q]! - m[p]![p]!), c = Math.cos(angle), s = Math.sin(angle);
            for (let k = 0; k < 3; ++k) [m[k]![p], m[k]![q]] = [c * m[k]![p]! - s * m[k]![q]!, s * m[k]![p]! + c * m[k]![q]!];
            for (let k = 0; k < 3; ++k) {
                [m[p]![k], m[q]![k]] = [c * m[p]![k]! - s * m[q]![k]!, s * m[p]![k]! + c * m[q]![k]!];
                [v[k]![p], v[k]![q]] = [c * v[k]![p]! - s * v[k]![q]!, s * v[k]![p]! + c * v[k]![q]!];
            }
        }
    return [0, 1, 2].map(k => [v[0]![k]!, v[1]![k]!, v[2]![k]!]);
}

export class Tetrahedra {
    /// Along how many axes the points extend. 0: they are one point, and there are no cells.
    rank = 0;
    centre: Triple = [0, 0, 0];
    axes: Triple[] = [];
    /// Places of the vertices in the frame of the axes, and whose vertex each is.
    readonly position: Triple[] = [];
    readonly point: number[] = [];
    cells: Cell[] = [];
    /// Boxes of the frame, and the cell from which to walk for a place in each: x runs first.
    bins: Triple = [1, 1, 1];
    binOrigin: Triple = [0, 0, 0];
    binSize: Triple = [1, 1, 1];
    readonly start: number[] = [];
    /// By how much the square of a vertex is raised.
    private readonly raised: number[] = [];
    private extent = 0;
    private spacing = 0;

    /// points: at least one.
    constructor(points: readonly Triple[]) {
        this.makeFrame(points);
        if (this.rank === 0) {
            this.point.push(0);
            return;
        }
        this.makeVertices(points);
        this.triangulate();
        this.makeShortcuts();
    }

    isGhost(cell: Cell): boolean {
        return cell.vertex.includes(k_ghost);
    }
    /// The places of the corners of the face opposite to a vertex of a cell.
    facePositions(cell: Cell, opposite: number): [Triple, Triple, Triple] {
        const [a, b, c] = k_face[opposite]!;
        return [this.position[cell.vertex[a]]!, this.position[cell.vertex[b]]!, this.position[cell.vertex[c]]!];
    }

    private makeFrame(points: readonly Triple[]): void {
        const n = points.length, spread = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
        this.centre = [0, 1, 2].map(k => points.reduce((sum, p) => sum + p[k]!, 0) / n) as Triple;
        for (const p of points) {
            const d = minus(p, this.centre);
            for (let i = 0; i < 3; ++i) for (let j = 0; j < 3; ++j) spread[i]![j]! += d[i]! * d[j]!;
        }
        const extents = principalAxes(spread).map(axis => {
            const along = points.map(p => dot(minus(p, this.centre), axis));
            return {axis, length: Math.max(...along) - Math.min(...along)};
        });
        extents.sort((a, b) => b.length - a.length);
        this.axes = extents.map(({axis}) => axis);
        const [e0, e1, e2] = extents.map(({length}) => length) as Triple, alongLine = e0 / n, onPlane = Math.sqrt((e0 * e1) / n);
        this.extent = e0;
        this.rank = !(e0 > 1e-6) ? 0 : n < 3 || e1 <= 0.5 * alongLine ? 1 : n < 4 || e2 <= 0.5 * onPlane ? 2 : 3;
        this.spacing = this.rank === 1 ? alongLine : this.rank === 2 ? onPlane : Math.cbrt((e0 * e1 * e2) / n);
        // What lies beside a line or plane of points counts as being on it.
        for (let k = this.rank; k < 3; ++k) this.axes[k] = [0, 0, 0];
    }

    private makeVertices(points: readonly Triple[]): void {
        const kept: Triple[] = [], own: number[] = [];
        points.forEach((p, i) => {
            const d = minus(p, this.centre), place = this.axes.map(axis => dot(d, axis)) as Triple;
            if (kept.some(other => distance(other, place) <= 1e-5 * this.extent)) return;
            kept.push(place);
            own.push(i);
        });
        kept.forEach((place, i) => {
            const nearest = kept.reduce((least, other, j) => (j === i ? least : Math.min(least, distance(other, place))), this.spacing), raise = 0.01 * nearest * nearest;
            this.addVertex(place, own[i]!, raise);
            for (let axis = 0; axis < this.rank; ++axis)
                for (const sign of [1, -1]) {
                    if (!this.isOutermost(kept, i, axis, sign)) continue;
                    const copy: Triple = [...place];
                    copy[axis]! += sign * this.spacing;
                    this.addVertex(copy, own[i]!, raise);
                }
        });
    }
    /// No other place is near in this direction.
    private isOutermost(places: readonly Triple[], i: number, axis: number, sign: number): boolean {
        return places.every((place, j) => {
            const to = minus(place, places[i]!), away = Math.hypot(...to);
            return j === i || !(sign * to[axis]! > 0.7 * away && away < 3 * this.spacing);
        });
    }
    /// Adds a point; where the points lie on a plane or a line, its layers on both sides of that.
    private addVertex(place: Triple, point: number, raise: number): void {
        const layers = 1 << (3 - this.rank);
        for (let layer = 0; layer < layers; ++layer) {
            const number = this.position.length, p: Triple = [...place];
            for (let axis = this.rank; axis < 3; ++axis) p[axis]! += ((layer >> (axis - this.rank)) & 1 ? 0.25 : -0.25) * this.spacing;
            for (let axis = 0; axis < 3; ++axis) p[axis]! += 1e-6 * this.extent * jitter(number, axis);
            this.raised.push(raise * jitter(number, 3));
            this.position.push(p);
            this.point.push(point);
        }
    }

    private triangulate(): void {
        // The first tetrahedron: of vertices that lie far apart.
        const {position} = this, a = position[0]!;
        const farthest = (measure: (p: Triple) => number) => position.reduce((best, p, i) => (i > 0 && measure(p) > measure(position[best]!) ? i : best), 0);
        const ib = farthest(p => distance(p, a)), b = position[ib]!;
        const ic = farthest(p => Math.hypot(...cross(minus(b, a), minus(p, a)))), c = position[ic]!;
        const id = farthest(p => Math.abs(orientation(a, b, c, p)));
        const first: Four = orientation(a, b, c, position[id]!) < 0 ? [ib, 0, ic, id] : [0, ib, ic, id];
        this.cells = [{vertex: first, neighbour: [1, 2, 3, 4], removed: false}];
        for (const face of k_face) {
            // A ghost lies on the other side of its face: the face's corners in the opposite order.
            const vertex: Four = [first[face[0]], first[face[2]], first[face[1]], k_ghost];
            this.cells.push({vertex, neighbour: [1 + first.indexOf(vertex[0]), 1 + first.indexOf(vertex[1]), 1 + first.indexOf(vertex[2]), 0], removed: false});
        }
        position.forEach((_, i) => first.includes(i) || this.insert(i));
        this.dropRemoved();
    }
    /// Whether a vertex lies inside of the sphere of a cell: below the hyperplane through its corners in four dimensions, if the fourth coordinate is the square of a
    /// point, raised. Of a ghost: outside of the hull, on the ghost's side of its face.
    private conflicts(cell: Cell, vertex: number): boolean {
        const p = this.position[vertex]!, ghost = cell.vertex.indexOf(k_ghost);
        if (ghost >= 0) {
            const [a, b, c] = this.facePositions(cell, ghost);
            return orientation(a, b, c, p) > 0;
        }
        const d = cell.vertex.map(v => minus(this.position[v]!, p)) as [Triple, Triple, Triple, Triple];
        const square = (i: number) => dot(d[i]!, d[i]!) + (this.raised[cell.vertex[i]!]! - this.raised[vertex]!);
        return square(0) * dot(cross(d[1], d[2]), d[3]) - square(1) * dot(cross(d[2], d[3]), d[0]) + square(2) * dot(cross(d[3], d[0]), d[1]) - square(3) * dot(cross(d[0], d[1]), d[2]) > 0;
    }
    private findConflict(vertex: number): number {
        // Vertices that follow each other are often neighbours in space, so the newest tetrahedra are tried first.
        for (let t = this.cells.length - 1; t >= 0; --t) if (!this.cells[t]!.removed && this.conflicts(this.cells[t]!, vertex)) return t;
        return -1;
    }
    private insert(vertex: number): void {
        // Find the cavity: all tetrahedra whose sphere holds the vertex. They are connected.
        const first = this.findConflict(vertex);
        if (first < 0) return;
        const cavity = [first], inCavity = new Set(cavity);
        for (const t of cavity)
            for (const next of this.cells[t]!.neighbour)
                if (!inCavity.has(next) && this.conflicts(this.cells[next]!, vertex)) {
                    inCavity.add(next);
                    cavity.push(next);
                }

        // Fill it with tetrahedra from its faces to the vertex, and join those that share an edge of the cavity.
        const open = new Map<string, [cell: number, side: number]>();
        for (const t of cavity) {
            const old = this.cells[t]!;
            for (let f = 0; f < 4; ++f) {
                const outer = old.neighbour[f]!, made = this.cells.length;
                if (inCavity.has(outer)) continue;
                const beyond = this.cells[outer]!.neighbour;
                beyond[beyond.indexOf(t)] = made;
                const face = k_face[f]!.map(k => old.vertex[k]!);
                const cell: Cell = {vertex: [face[0]!, face[1]!, face[2]!, vertex], neighbour: [-1, -1, -1, outer], removed: false};
                this.cells.push(cell);
                for (let k = 0; k < 3; ++k) {
                    const u = face[(k + 1) % 3]!, v = face[(k + 2) % 3]!, key = u < v ? `${u} ${v}` : `${v} ${u}`, found = open.get(key);
                    if (!found) {
                        open.set(key, [made, k]);
                        continue;
                    }
                    cell.neighbour[k] = found[0];
                    this.cells[found[0]]!.neighbour[found[1]] = made;
                }
            }
            old.removed = true;
        }
    }
    private dropRemoved(): void {
        const places: number[] = [];
        let count = 0;
        this.cells.forEach((cell, t) => (places[t] = cell.removed ? -1 : count++));
        this.cells = this.cells.filter(({removed}) => !removed);
        for (const cell of this.cells) cell.neighbour = cell.neighbour.map(t => places[t]!) as Four;
    }

    private makeShortcuts(): void {
        const {position} = this, edgeOf = (pick: (...v: number[]) => number, k: number) => position.reduce((m, p) => pick(m, p[k]!), position[0]![k]!);
        const low = [0, 1, 2].map(k => edgeOf(Math.min, k)) as Triple, size = [0, 1, 2].map(k => edgeOf(Math.max, k) - low[k]!) as Triple;
        const edge = Math.cbrt((size[0] * size[1] * size[2]) / position.length);
        this.bins = size.map(length => Math.min(64, Math.max(1, Math.round(length / edge)))) as Triple;
        this.binOrigin = low;
        this.binSize = size.map((length, k) => length / this.bins[k]!) as Triple;
        let last = this.cells.findIndex(cell => !this.isGhost(cell));
        for (let z = 0; z < this.bins[2]; ++z)
            for (let y = 0; y < this.bins[1]; ++y)
                for (let x = 0; x < this.bins[0]; ++x) {
                    last = this.walk([x, y, z].map((n, k) => low[k]! + this.binSize[k]! * (n + 0.5)) as Triple, last);
                    this.start.push(last);
                }
    }
    /// The tetrahedron that holds a place in the frame, by walking from `start`; outside of the hull, the one behind the face where the walk leaves it.
    private walk(place: Triple, start: number): number {
        let t = start;
        for (let step = 0; step < this.cells.length; ++step) {
            const cell = this.cells[t]!;
            let next = -1;
            for (let f = 0; f < 4 && next < 0; ++f) if (orientation(...this.facePositions(cell, f), place) < 0) next = cell.neighbour[f]!;
            if (next < 0 || this.isGhost(this.cells[next]!)) return t;
            t = next;
        }
        return t;
    }
}
