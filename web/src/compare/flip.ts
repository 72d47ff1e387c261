// FLIP: Andersson et al. 2020, "FLIP: A difference evaluator for alternating images". The C++ is src/compare/flip.cpp, whose names and
// numbers of equations these are.

type Vec3 = [number, number, number];
type Taps = number[];

const qc = 0.7, pc = 0.4, pt = 0.95, qf = 0.5, featureWidthDeg = 0.082;
/// Of a display 0.7 m away, 3840 pixels over 0.7 m: the paper's.
export const pixelsPerDegree = 67.02;

const toXyz: Vec3[] = [
    [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
    [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
    [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
];
/// XYZ relative to the white's, by rows.
const toRelative = toXyz.map(row => row.map(v => v / (row[0] + row[1] + row[2]))) as Vec3[];
const fromRelative = inverse(toRelative);

function inverse(a: Vec3[]): Vec3[] {
    const cofactor = (i: number, j: number) => {
        const i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        return a[i1]![j1]! * a[i2]![j2]! - a[i1]![j2]! * a[i2]![j1]!;
    };
    const determinant = a[0]![0] * cofactor(0, 0) + a[0]![1] * cofactor(0, 1) + a[0]![2] * cofactor(0, 2);
    return [0, 1, 2].map(j => [0, 1, 2].map(i => cofactor(i, j) / determinant)) as Vec3[];
}
const times = (m: Vec3[], x: number, y: number, z: number): Vec3 =>
    [m[0]![0] * x + m[0]![1] * y + m[0]![2] * z, m[1]![0] * x + m[1]![1] * y + m[1]![2] * z, m[2]![0] * x + m[2]![1] * y + m[2]![2] * z];

const labCurve = (t: number) => (t > (6 / 29) ** 3 ? Math.cbrt(t) : t / (3 * (6 / 29) ** 2) + 4 / 29);

/// CIELAB, its chroma scaled by lightness (eq. 3).
function huntLab(r: number, g: number, b: number): Vec3 {
    const [x, y, z] = times(toRelative, r, g, b), fx = labCurve(x), fy = labCurve(y), fz = labCurve(z), l = 116 * fy - 16;
    return [l, 0.01 * l * 500 * (fx - fy), 0.01 * l * 200 * (fy - fz)];
}
/// Eq. 4.
const hyab = (a: Vec3, b: Vec3) => Math.abs(a[0] - b[0]) + Math.hypot(a[1] - b[1], a[2] - b[2]);
const largest = hyab(huntLab(0, 1, 0), huntLab(0, 0, 1)) ** qc;
/// Eq. 5 and 6.
function redistribute(difference: number): number {
    const d = difference ** qc, knee = pc * largest;
    return d < knee ? (pt / knee) * d : pt + ((d - knee) / (largest - knee)) * (1 - pt);
}

const taps = (radius: number, f: (i: number) => number): Taps => Array.from({length: 2 * radius + 1}, (_, k) => f(k - radius));
const sum = (t: Taps) => t.reduce((a, b) => a + b);
const scaled = (t: Taps, factor: number) => t.map(v => v * factor);
const gaussian = (b: number, radius: number) => taps(radius, i => Math.exp((-(Math.PI ** 2) * (i / pixelsPerDegree) ** 2) / b));

/// Sensitivity to contrast in each opponent channel (section 4.1.1).
function sensitivityFilters(): {y: Taps; cx: Taps; cz1: Taps; cz2: Taps} {
    const radius = Math.ceil(3 * Math.sqrt(0.04 / (2 * Math.PI ** 2)) * pixelsPerDegree);
    const [y, cx, cz1, cz2] = [0.0047, 0.0053, 0.04, 0.025].map(b => gaussian(b, radius)) as [Taps, Taps, Taps, Taps];
    const w1 = 34.1 * Math.sqrt(Math.PI / 0.04), w2 = 13.5 * Math.sqrt(Math.PI / 0.025), total = w1 * sum(cz1) ** 2 + w2 * sum(cz2) ** 2;
    return {y: scaled(y, 1 / sum(y)), cx: scaled(cx, 1 / sum(cx)), cz1: scaled(cz1, Math.sqrt(w1 / total)), cz2: scaled(cz2, Math.sqrt(w2 / total))};
}
/// Derivatives of a Gaussian whose positive taps add up to 1, and the negative ones to -1 (section 4.2).
function featureFilters(): {smooth: Taps; edge: Taps; point: Taps} {
    const sigma = 0.5 * featureWidthDeg * pixelsPerDegree, radius = Math.ceil(3 * sigma), g = (i: number) => Math.exp((-i * i) / (2 * sigma * sigma));
    const balanced = (t: Taps) => {
        const positive = sum(t.filter(v => v > 0)), negative = sum(t.filter(v => v < 0));
        return t.map(v => (v > 0 ? v / positive : -v / negative));
    };
    const smooth = taps(radius, g);
    return {smooth: scaled(smooth, 1 / sum(smooth)), edge: balanced(taps(radius, i => -i * g(i))), point: balanced(taps(radius, i => ((i * i) / (sigma * sigma) - 1) * g(i)))};
}

/// A separable filter; the plane's border is repeated outside.
function filter(plane: Float32Array, width: number, height: number, along: Taps, down: Taps): Float32Array {
    const middle = new Float32Array(plane.length), out = new Float32Array(plane.length), ra = (along.length - 1) / 2, rd = (down.length - 1) / 2;
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x) {
            let s = 0;
            for (let k = -ra; k <= ra; ++k) s += along[k + ra]! * plane[y * width + Math.min(width - 1, Math.max(0, x + k))]!;
            middle[y * width + x] = s;
        }
    for (let y = 0; y < height; ++y)
        for (let k = -rd; k <= rd; ++k) {
            const row = Math.min(height - 1, Math.max(0, y + k)) * width, t = down[k + rd]!;
            for (let x = 0; x < width; ++x) out[y * width + x]! += t * middle[row + x]!;
        }
    return out;
}

interface Seen {
    lab: Float32Array;
    edge: Float32Array;
    point: Float32Array;
}

const linear = Float32Array.from({length: 256}, (_, i) => (i / 255 <= 0.04045 ? i / 255 / 12.92 : ((i / 255 + 0.055) / 1.055) ** 2.4));
const unit = (v: number) => Math.min(1, Math.max(0, v));

/// One picture (RGBA bytes of sRGB) as both pipelines see it.
function see(rgba: Uint8Array, width: number, height: number): Seen {
    const n = width * height, planes = [new Float32Array(n), new Float32Array(n), new Float32Array(n)] as const;
    for (let k = 0; k < n; ++k) {
        const [x, y, z] = times(toRelative, linear[rgba[4 * k]!]!, linear[rgba[4 * k + 1]!]!, linear[rgba[4 * k + 2]!]!);
        planes[0][k] = 116 * y - 16;
        planes[1][k] = 500 * (x - y);
        planes[2][k] = 200 * (y - z);
    }
    const s = sensitivityFilters(), apply = (plane: Float32Array, a: Taps, d: Taps) => filter(plane, width, height, a, d);
    const ys = apply(planes[0], s.y, s.y), cx = apply(planes[1], s.cx, s.cx), cz1 = apply(planes[2], s.cz1, s.cz1), cz2 = apply(planes[2], s.cz2, s.cz2);
    const lab = new Float32Array(3 * n);
    for (let k = 0; k < n; ++k) {
        const y = (ys[k]! + 16) / 116, [r, g, b] = times(fromRelative, y + cx[k]! / 500, y, y - (cz1[k]! + cz2[k]!) / 200);
        lab.set(huntLab(unit(r), unit(g), unit(b)), 3 * k);
    }
    const light = planes[0].map(v => (v + 16) / 116), f = featureFilters();
    const magnitude = (t: Taps) => {
        const h = apply(light, t, f.smooth), v = apply(light, f.smooth, t);
        return h.map((a, k) => Math.hypot(a, v[k]!));
    };
    return {lab, edge: magnitude(f.edge), point: magnitude(f.point)};
}

/// The error of each pixel, 0 to 1. Pictures: RGBA bytes of sRGB.
export function flip(test: Uint8Array, reference: Uint8Array, width: number, height: number): Float32Array {
    const a = see(reference, width, height), b = see(test, width, height);
    const at = (lab: Float32Array, k: number): Vec3 => [lab[3 * k]!, lab[3 * k + 1]!, lab[3 * k + 2]!];
    return Float32Array.from({length: width * height}, (_, k) => {
        const colour = redistribute(hyab(at(a.lab, k), at(b.lab, k)));
        const feature = Math.max(Math.abs(a.edge[k]! - b.edge[k]!), Math.abs(a.point[k]! - b.point[k]!));
        return unit(colour ** (1 - unit(feature / Math.SQRT2) ** qf));  // eq. 8 and 9
    });
}
