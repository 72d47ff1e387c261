// The default environment, computed in the page: a photographer's studio of soft boxes, in linear radiance.

import type {Latlong} from '../bake/types';

interface SoftBox {
    azimuthDeg: number;
    elevationDeg: number;
    /// Half of its width and height.
    halfDeg: [number, number];
    radiance: [number, number, number];
}

const boxes: SoftBox[] = [
    {azimuthDeg: 40, elevationDeg: 38, halfDeg: [24, 15], radiance: [14, 12.9, 11.6]},
    {azimuthDeg: 148, elevationDeg: 22, halfDeg: [9, 30], radiance: [3.2, 3.9, 5.2]},
    {azimuthDeg: -92, elevationDeg: 30, halfDeg: [5, 34], radiance: [7.5, 7.8, 8.2]},
    {azimuthDeg: 95, elevationDeg: 80, halfDeg: [40, 7], radiance: [2.6, 2.6, 2.7]},
];

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
function radiance(azimuthDeg: number, elevationDeg: number): [number, number, number] {
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

export function studio(height = 256): Latlong {
    const width = 2 * height, pixels = new Float32Array(3 * width * height);
    for (let y = 0, to = 0; y < height; ++y)
        for (let x = 0; x < width; ++x, to += 3) pixels.set(radiance(((x + 0.5) / width) * 360 - 180, 90 - ((y + 0.5) / height) * 180), to);
    return {width, height, pixels};
}

/// Radiance 1 from everywhere.
export function whiteFurnace(height = 32): Latlong {
    return {width: 2 * height, height, pixels: new Float32Array(6 * height * height).fill(1)};
}
