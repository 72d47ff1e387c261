// What a shader draws light directions with: row averages for the two loops, cumulative weights and guides for inversion.

import {k_bins_per_ev, k_least_ev, type Latlong, type Survey, type Tables} from './types';

/// The tables of a map that is reduced to `rows` rows if it has more.
export function makeTables(source: Latlong, rows: number): Tables {
    const map = source.height > rows ? reduce(source, rows) : source, {width, height, pixels} = map;
    const texels = new Float32Array(4 * width * height), columns = new Float32Array(2 * width * height), averages = new Float64Array(height);
    const weights = new Float64Array(width);
    for (let y = 0; y < height; ++y) {
        const sine = Math.sin((Math.PI * (y + 0.5)) / height);
        let sum = 0;
        for (let x = 0; x < width; ++x) {
            const from = 3 * (y * width + x), r = pixels[from]!, g = pixels[from + 1]!, b = pixels[from + 2]!;
            texels.set([r, g, b, 1], 4 * (y * width + x));
            sum += weights[x] = (0.2126 * r + 0.7152 * g + 0.0722 * b) * sine;
        }
        averages[y] = sum / width;
        columns.set(cumulative(weights), 2 * y * width);
    }
    const total = averages.reduce((a, b) => a + b) / height;
    return {width, height, texels, rowAverages: Float32Array.from(averages), totalAverage: total, columns, rows: cumulative(averages)};
}

/// Pairs for each cell: the sum of the weights up to and with it, of 1; and a guide, the first cell whose sum is above its number / n.
function cumulative(weights: Float64Array): Float32Array {
    const n = weights.length, out = new Float32Array(2 * n), total = weights.reduce((a, b) => a + b);
    if (!(total > 0)) return out;
    let sum = 0, last = 0;
    weights.forEach((w, i) => {
        sum += w;
        out[2 * i] = sum / total;
        if (w > 0) last = i;
    });
    for (let i = last; i < n; ++i) out[2 * i] = 1;
    for (let cell = 0, i = 0; cell < n; ++cell) {
        while (out[2 * i]! <= cell / n) ++i;
        out[2 * cell + 1] = i;
    }
    return out;
}

/// Means over blocks, by solid angle, so that no light is lost.
export function reduce(source: Latlong, rows: number): Latlong {
    const factor = Math.ceil(source.height / rows), height = Math.floor(source.height / factor), width = Math.floor(source.width / factor);
    const pixels = new Float32Array(3 * width * height), sums = new Float64Array(3 * width);
    for (let y = 0; y < height; ++y) {
        sums.fill(0);
        let weight = 0;
        for (let dy = 0; dy < factor; ++dy) {
            const row = y * factor + dy, w = Math.cos((Math.PI * row) / source.height) - Math.cos((Math.PI * (row + 1)) / source.height);
            weight += w * factor;
            for (let x = 0; x < width * factor; ++x)
                for (let c = 0; c < 3; ++c) sums[3 * Math.floor(x / factor) + c]! += w * source.pixels[3 * (row * source.width + x) + c]!;
        }
        sums.forEach((v, k) => (pixels[3 * y * width + k] = v / weight));
    }
    return {width, height, pixels};
}

/// Points of the unit square, (u, v) each, that are drawn from the environment's luminance by inversion of its tables. The random points
/// are those of the R2 sequence (Roberts 2018).
export function drawSamples(source: Latlong, count: number): Float32Array {
    const {width, height, columns, rows} = makeTables(source, 256), out = new Float32Array(2 * count);
    const invert = (table: Float32Array, n: number, random: number) => {
        let i = table[2 * Math.floor(random * n) + 1]!;
        while (i < n - 1 && table[2 * i]! <= random) ++i;
        const below = i > 0 ? table[2 * i - 2]! : 0;
        return (i + Math.min(0.999999, (random - below) / (table[2 * i]! - below))) / n;
    };
    for (let k = 0; k < count; ++k) {
        const v = invert(rows, height, (0.5 + k * 0.5698402909980532) % 1), row = Math.floor(v * height);
        out[2 * k] = invert(columns.subarray(2 * row * width, 2 * (row + 1) * width), width, (0.5 + k * 0.7548776662466927) % 1);
        out[2 * k + 1] = v;
    }
    return out;
}

/// A small map, and how the sphere's luminance is spread.
export function survey(source: Latlong, rows: number): Survey {
    const {width, height, pixels} = source, histogram = new Float32Array(32 * k_bins_per_ev);
    let mean = 0, peak = 0;
    for (let y = 0; y < height; ++y) {
        const weight = (Math.cos((Math.PI * y) / height) - Math.cos((Math.PI * (y + 1)) / height)) / 2 / width;
        for (let x = 0, k = 3 * y * width; x < width; ++x, k += 3) {
            const luminance = 0.2126 * pixels[k]! + 0.7152 * pixels[k + 1]! + 0.0722 * pixels[k + 2]!;
            mean += weight * luminance;
            peak = Math.max(peak, luminance);
            const bin = Math.floor((Math.log2(luminance) - k_least_ev) * k_bins_per_ev);
            if (luminance > 0) histogram[Math.min(histogram.length - 1, Math.max(0, bin))]! += weight;
        }
    }
    const thumbnail = height > rows ? reduce(source, rows) : {width, height, pixels: pixels.slice()};
    return {thumbnail, histogram, meanLuminance: mean, peakLuminance: peak};
}
