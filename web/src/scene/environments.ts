// Environments that are computed in the page, in linear radiance: a photographer's studio of soft boxes, and an evening sky.

import type {Latlong} from '../bake/types';

interface SoftBox {
    azimuthDeg: number;
    elevationDeg: number;
    /// Half of its width and height.
    halfDeg: [number, number];
    radiance: [number, number, number];
}

// Azimuth 0 is +X and 90 is +Z, which is behind the viewer.
const boxes: SoftBox[] = [
    {azimuthDeg: 48, elevationDeg: 38, halfDeg: [22, 15], radiance: [14, 12.9, 11.6]},
    {azimuthDeg: 138, elevationDeg: 18, halfDeg: [9, 30], radiance: [3.4, 4.1, 5.4]},
    {azimuthDeg: -22, elevationDeg: 22, halfDeg: [4, 30], radiance: [9, 9.2, 9.6]},
    {azimuthDeg: -158, elevationDeg: 22, halfDeg: [4, 30], radiance: [7, 7.4, 8]},
    {azimuthDeg: 90, elevationDeg: 82, halfDeg: [38, 7], radiance: [2.6, 2.6, 2.7]},
];

/// From 0 at `low` to 1 at `high`, which may be below it.
const smoothstep = (low: number, high: number, x: number) => {
    const t = Math.min(1, Math.max(0, (x - low) / (high - low)));
    return t * t * (3 - 2 * t);
};

/// How much of a box is seen, 0 to 1, with an edge that is one degree wide.
function coverage(box: SoftBox, azimuthDeg: number, elevationDeg: number): number {
    const rad = Math.PI / 180, e = elevationDeg * rad, e0 = box.elevationDeg * rad, a = (azimuthDeg - box.azimuthDeg) * rad;
    // The box's tangent plane: x to the right, y up.
    const depth = Math.sin(e) * Math.sin(e0) + Math.cos(e) * Math.cos(e0) * Math.cos(a);
    if (depth <= 0.05) return 0;
    const x = (Math.cos(e) * Math.sin(a)) / depth, y = (Math.sin(e) * Math.cos(e0) - Math.cos(e) * Math.sin(e0) * Math.cos(a)) / depth;
    const edge = 0.02;
    return (1 - smoothstep(Math.tan(box.halfDeg[0] * rad) - edge, Math.tan(box.halfDeg[0] * rad), Math.abs(x))) *
           (1 - smoothstep(Math.tan(box.halfDeg[1] * rad) - edge, Math.tan(box.halfDeg[1] * rad), Math.abs(y)));
}

/// A floor that is lit from above, walls that become darker upwards, and the boxes.
function studioRadiance(azimuthDeg: number, elevationDeg: number): [number, number, number] {
    const up = Math.sin((elevationDeg * Math.PI) / 180);
    const wall = 0.16 + 0.1 * smoothstep(0.9, -0.1, up), floor = 0.34 - 0.2 * smoothstep(-0.02, -0.9, up);
    const grey = wall + (floor - wall) * smoothstep(0.02, -0.06, up);
    const light: [number, number, number] = [grey * 0.97, grey, grey * 1.05];
    for (const box of boxes) {
        const c = coverage(box, azimuthDeg, elevationDeg);
        for (let k = 0; k < 3; ++k) light[k] = light[k]! * (1 - c) + box.radiance[k]! * c;
    }
    return light;
}

type Radiance = (azimuthDeg: number, elevationDeg: number) => [number, number, number];

function latlongOf(radiance: Radiance, height: number): Latlong {
    const width = 2 * height, pixels = new Float32Array(3 * width * height);
    for (let y = 0, to = 0; y < height; ++y)
        for (let x = 0; x < width; ++x, to += 3) pixels.set(radiance(((x + 0.5) / width) * 360 - 180, 90 - ((y + 0.5) / height) * 180), to);
    return {width, height, pixels};
}

export const studio = (): Latlong => latlongOf(studioRadiance, 256);

const mix = (a: number[], b: number[], t: number) => a.map((v, k) => v + (b[k]! - v) * t) as [number, number, number];

/// A sky that is blue above and orange around a low sun, over dark ground. Painted, not simulated: `domelight sky` computes a real one.
function sunsetRadiance(azimuthDeg: number, elevationDeg: number): [number, number, number] {
    const rad = Math.PI / 180, e = elevationDeg * rad, sunE = 7 * rad, a = (azimuthDeg - 60) * rad;
    const toSun = Math.acos(Math.min(1, Math.sin(e) * Math.sin(sunE) + Math.cos(e) * Math.cos(sunE) * Math.cos(a))) / rad;
    const height = Math.max(0, Math.sin(e)), glow = Math.exp(-toSun / 22);
    const horizon = mix([0.34, 0.3, 0.36], [2.3, 0.95, 0.32], glow), zenith = [0.1, 0.19, 0.42];
    const sky = mix(horizon, zenith, 1 - Math.exp(-4.5 * height));
    const halo = 3 * Math.exp(-toSun / 4), disc = 2600 * smoothstep(1.1, 0.7, toSun);
    const lit = sky.map((v, k) => v + (halo + disc) * [1, 0.62, 0.28][k]!);
    const ground = mix([0.05, 0.045, 0.04], [0.16, 0.09, 0.05], glow * Math.exp(elevationDeg / 30));
    return mix(lit, ground, smoothstep(0.4, -0.4, elevationDeg));
}

export const sunset = (): Latlong => latlongOf(sunsetRadiance, 512);

/// Radiance 1 from everywhere.
export function whiteFurnace(): Latlong {
    const height = 32;
    return {width: 2 * height, height, pixels: new Float32Array(6 * height * height).fill(1)};
}
