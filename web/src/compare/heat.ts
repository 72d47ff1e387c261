// A map of colours whose lightness rises evenly, from violet-black through red to yellow-white.

const stops: [number, number, number][] = [[0, 0, 4], [40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39], [252, 255, 164]];

export function heatColour(value: number): [number, number, number] {
    const x = Math.min(1, Math.max(0, value)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(x)), t = x - i;
    return stops[i]!.map((v, c) => Math.round(v + t * (stops[i + 1]![c]! - v))) as [number, number, number];
}

/// The same in GLSL: vec3 heat(float value).
export const heatShader = (): string => `const vec3 k_heat[${stops.length}] = vec3[](${stops.map(stop => `vec3(${stop.join()}) / 255.0`).join()});
vec3 heat(float value) {
    float x = clamp(value, 0.0, 1.0) * ${stops.length - 1}.0;
    int i = min(${stops.length - 2}, int(x));
    return mix(k_heat[i], k_heat[i + 1], x - float(i));
}
`;

/// Values of 0 to 1 as RGBA bytes.
export function heat(values: Float32Array): Uint8Array {
    const table = Array.from({length: 256}, (_, i) => heatColour(i / 255)), out = new Uint8Array(4 * values.length);
    values.forEach((v, k) => {
        const colour = table[Math.round(255 * Math.min(1, Math.max(0, v)))]!;
        out.set(colour, 4 * k);
        out[4 * k + 3] = 255;
    });
    return out;
}
