// What a shader draws light directions with: row averages for the two loops, cumulative weights and guides for inversion.

import type {Latlong, Tables} from './types';

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
function reduce(source: Latlong, rows: number): Latlong {
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
