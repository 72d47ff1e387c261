// What is measured in the pictures.

import {latlongPixel, look} from './balls.mjs';

export const axes = {'+X': [1, 0, 0], '-X': [-1, 0, 0], '+Y': [0, 1, 0], '-Y': [0, -1, 0], '+Z': [0, 0, 1], '-Z': [0, 0, -1]};

const distance = (a, b) => Math.max(Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1]), Math.abs(a[2] - b[2]));
const texel = (image, d) => {
    const [x, y] = latlongPixel(image, d);
    const at = 3 * (Math.min(image.height - 1, Math.floor(y)) * image.width + Math.floor(x) % image.width);
    return [image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]];
};
/// Bilinear, so only for smooth pictures.
function smooth(image, d) {
    const [x, y] = latlongPixel(image, d).map(v => v - 0.5);
    const left = Math.floor(x), top = Math.floor(y), u = x - left, v = y - top, sum = [0, 0, 0];
    for (const [i, j, weight] of [[0, 0, (1 - u) * (1 - v)], [1, 0, u * (1 - v)], [0, 1, (1 - u) * v], [1, 1, u * v]]) {
        const row = Math.min(image.height - 1, Math.max(0, top + j)), column = (left + i + image.width) % image.width;
        for (let c = 0; c < 3; ++c) sum[c] += weight * image.rgb[3 * (row * image.width + column) + c];
    }
    return sum;
}

/// Light filtered for any roughness, from lat-long pictures of equally spaced ones, 0 to 1: (direction, roughness) => [r, g, b].
export const filteredLight = pictures => (d, roughness) => {
    const at = Math.min(1, Math.max(0, roughness)) * (pictures.length - 1), low = Math.min(pictures.length - 2, Math.floor(at));
    const a = smooth(pictures[low], d), b = smooth(pictures[low + 1], d);
    return a.map((v, c) => v + (at - low) * (b[c] - v));
};

/// What white GGX without multiple scattering reflects of a white furnace, by importance sampling visible normals (Heitz 2018).
function directionalAlbedo(NdotV, alpha, samples = 1024) {
    const V = [alpha * Math.sqrt(1 - NdotV * NdotV), 0, NdotV], length = Math.hypot(...V), v = V.map(x => x / length);
    const lambda = c => (Math.sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2;
    let sum = 0;
    for (let k = 0; k < samples; ++k) {
        const r = Math.sqrt((k + 0.5) / samples), phi = 2 * Math.PI * (k * 0.6180339887498949 % 1);
        const t1 = r * Math.cos(phi), t2 = (1 - v[2]) / 2 * Math.sqrt(1 - t1 * t1) + (1 + v[2]) / 2 * r * Math.sin(phi);
        const t3 = Math.sqrt(Math.max(0, 1 - t1 * t1 - t2 * t2));
        // The frame about v is (0, 1, 0) and v x that.
        const h = [-v[2] * t2 + v[0] * t3, t1, v[0] * t2 + v[2] * t3];
        const n = [alpha * h[0], alpha * h[1], Math.max(1e-6, h[2])], m = n.map(x => x / Math.hypot(...n));
        const VdotH = Math.sqrt(1 - NdotV * NdotV) * m[0] + NdotV * m[2], NdotL = 2 * VdotH * m[2] - NdotV;
        if (NdotL > 0) sum += (1 + lambda(NdotV)) / (1 + lambda(NdotV) + lambda(NdotL));
    }
    return sum / samples;
}

const albedos = new Map();

/// The same from a table of NdotV and roughness.
export function albedoOf(NdotV, roughness) {
    const key = `${Math.round(32 * NdotV)} ${roughness.toFixed(2)}`;
    if (!albedos.has(key)) albedos.set(key, directionalAlbedo(Math.max(1 / 64, Math.round(32 * NdotV) / 32), Math.max(1e-3, roughness * roughness)));
    return albedos.get(key);
}

/// Replaces the white metals of a picture by the values of `metal`. `light` is as `filteredLight` makes it; `widened` an engine's `roughness`.
export function drawMetals(scene, picture, light, metal, widened) {
    const step = 2 / scene.radius / scene.height;  // the picture is 4 units high
    const E = normal => light(normal, 1);  // at roughness 1 the lobe is the clamped cosine
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const sum = [0, 0, 0];
            const looks = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(([u, v]) => look(scene, x + u, y + v));
            if (looks.some(l => !l || scene.balls[l.ball].roughness === undefined)) continue;
            for (const seen of looks) {
                const roughness = widened ? widened(scene.balls[seen.ball].roughness, 2 * step / Math.max(0.3, seen.NdotV)) : scene.balls[seen.ball].roughness;
                metal({L: light, E, roughness, normal: seen.normal, reflected: seen.reflected, albedo: albedoOf(seen.NdotV, roughness)})
                    .forEach((v, c) => { sum[c] += v / 4; });
            }
            picture.rgba.set(sum, 4 * (y * picture.width + x));
        }
}

const pixel = (picture, x, y) => Array.from(picture.rgba.subarray(4 * (y * picture.width + x), 4 * (y * picture.width + x) + 3));

/// The colour of an axis's label: the commonest in a circle of 10 degrees about it that is not white.
export function labelColour(environment, axis) {
    const side = [axis[1], axis[2], axis[0]], up = [axis[2], axis[0], axis[1]];
    const counts = new Map();
    for (let k = 0; k < 400; ++k) {
        const r = 0.4 * Math.sqrt(k / 400), a = 2.4 * k;
        const colour = texel(environment, axis.map((v, i) => v + r * Math.cos(a) * side[i] + r * Math.sin(a) * up[i]));
        if (Math.min(...colour) > 0.8) continue;
        const key = colour.map(v => v.toFixed(2)).join();
        counts.set(key, {colour, count: (counts.get(key)?.count ?? 0) + 1});
    }
    return [...counts.values()].sort((a, b) => b.count - a.count)[0].colour;
}

/// What the mirror ball shows of each axis's label: {name: {at: [x, y], shift: [x, y], pixels, matching}}. `at` is the label's middle as geometry has
/// it, `shift` the whole pixels by which the picture fits it best, and `matching` the part of the `pixels` well inside the label that have its colour.
export function findLabels(scene, environment, picture) {
    const colours = Object.values(axes).map(axis => labelColour(environment, axis));
    const nearest = (colour, within) => colours.findIndex(c => distance(c, colour) < within);
    const inside = Object.keys(axes).map(() => []), judged = Object.keys(axes).map(() => []);
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const seen = look(scene, x + 0.5, y + 0.5);
            if (!seen || seen.NdotV < 0.25) continue;
            // The pixels of a label are those that see it within 6 degrees. Only those are compared that see nothing else, so neither its rim nor its
            // letters.
            const d = seen.reflected, side = Math.abs(d[1]) < 0.9 ? [-d[2], 0, d[0]] : [0, d[2], -d[1]];
            const up = [side[1] * d[2] - side[2] * d[1], side[2] * d[0] - side[0] * d[2], side[0] * d[1] - side[1] * d[0]];
            const labels = [nearest(texel(environment, d), 0.05)];
            for (let k = 0; k < 12; ++k) {
                const u = 0.1 * Math.cos(k * Math.PI / 6) / Math.hypot(...side), v = 0.1 * Math.sin(k * Math.PI / 6) / Math.hypot(...up);
                labels.push(nearest(texel(environment, d.map((c, i) => c + u * side[i] + v * up[i])), 0.05));
            }
            const label = labels.find(l => l >= 0);
            if (label === undefined) continue;
            inside[label].push([x, y, texel(environment, d)]);
            if (labels.every(l => l === label)) judged[label].push([x, y]);
        }
    const shifts = Array.from({length: 9 * 9}, (_, k) => [k % 9 - 4, Math.floor(k / 9) - 4]);
    return Object.fromEntries(Object.keys(axes).map((name, k) => {
        const misfit = ([u, v]) => inside[k].reduce((sum, [x, y, colour]) => {
            const there = x + u >= 0 && x + u < scene.width && y + v >= 0 && y + v < scene.height ? pixel(picture, x + u, y + v) : [0, 0, 0];
            return sum + there.reduce((s, value, c) => s + (value - colour[c]) ** 2, 0);
        }, 0);
        const shift = shifts.map(s => ({s, e: misfit(s)})).sort((a, b) => a.e - b.e)[0].s;
        const middle = [0, 1].map(c => inside[k].reduce((sum, p) => sum + p[c] + 0.5, 0) / inside[k].length);
        const right = judged[k].filter(([x, y]) => nearest(pixel(picture, x, y), 0.2) === k).length;
        return [name, {at: middle, shift, pixels: judged[k].length, matching: right / judged[k].length}];
    }));
}

/// Mean RGB of each ball within `part` of its radius: {name: [r, g, b]}.
export function ballMeans(scene, picture, part) {
    const sums = scene.balls.map(() => [0, 0, 0, 0]);
    const least = Math.sqrt(1 - part * part);
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const seen = look(scene, x + 0.5, y + 0.5);
            if (!seen || seen.NdotV < least) continue;
            pixel(picture, x, y).forEach((v, c) => { sums[seen.ball][c] += v; });
            ++sums[seen.ball][3];
        }
    return Object.fromEntries(scene.balls.map((ball, k) => [ball.name, sums[k].slice(0, 3).map(v => v / sums[k][3])]));
}

/// Per ball the RMS of a picture's difference from a reference over the reference's mean, within `part` of its radius.
export function ballErrors(scene, picture, reference, part) {
    const sums = scene.balls.map(() => ({error: 0, value: 0, count: 0}));
    const least = Math.sqrt(1 - part * part);
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const seen = look(scene, x + 0.5, y + 0.5);
            if (!seen || seen.NdotV < least) continue;
            const a = pixel(picture, x, y), b = pixel(reference, x, y);
            for (let c = 0; c < 3; ++c) {
                sums[seen.ball].error += (a[c] - b[c]) ** 2;
                sums[seen.ball].value += b[c];
                ++sums[seen.ball].count;
            }
        }
    return Object.fromEntries(scene.balls.map((ball, k) => [ball.name, Math.sqrt(sums[k].error / sums[k].count) / (sums[k].value / sums[k].count)]));
}

/// How alike two pictures of a scene are: the correlation of their values, cut at 1, within 0.95 of the balls' radius.
export function likeness(scene, a, b) {
    const sums = [0, 0, 0, 0, 0, 0];
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const seen = look(scene, x + 0.5, y + 0.5);
            if (!seen || seen.NdotV < 0.31) continue;
            const there = pixel(b, x, y);
            pixel(a, x, y).forEach((v, c) => {
                const p = Math.min(1, v), q = Math.min(1, there[c]);
                [1, p, q, p * p, q * q, p * q].forEach((t, k) => { sums[k] += t; });
            });
        }
    const [n, p, q, pp, qq, pq] = sums;
    return (pq / n - p * q / n / n) / Math.sqrt((pp / n - (p / n) ** 2) * (qq / n - (q / n) ** 2));
}
