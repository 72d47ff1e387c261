// Nine harmonics of the irradiance, and how far they are from it.

import type {Baker} from './baker';

/// E / π in a direction, from the coefficients of E: as domelight_diffuse_sh() of docs/shaders/generic.glsl, but without its cut at 0.
export function irradianceOverPi(sh: Float32Array, x: number, y: number, z: number): [number, number, number] {
    const basis = [0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z, 0.315392 * (3 * z * z - 1), 1.092548 * z * x, 0.546274 * (x * x - y * y)];
    return [0, 1, 2].map(c => basis.reduce((sum, b, k) => sum + b * sh[3 * k + c]!, 0) / Math.PI) as [number, number, number];
}

export interface HarmonicsError {
    width: number;
    height: number;
    /// Of each cell of a lat-long map: the difference of luminance, of the mean luminance of E / π.
    errors: Float32Array;
    rms: number;
    most: number;
}

const luminance = (r: number, g: number, b: number) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/// Against the exact irradiance, in 48 x 24 directions.
export async function harmonicsError(baker: Baker, sh: Float32Array): Promise<HarmonicsError> {
    const width = 48, height = 24, directions = new Float64Array(3 * width * height), errors = new Float32Array(width * height), mean = luminance(sh[0]!, sh[1]!, sh[2]!) * 0.282095 / Math.PI;
    for (let k = 0; k < errors.length; ++k) {
        const phi = (((k % width) + 0.5) / width - 0.5) * 2 * Math.PI, theta = ((Math.floor(k / width) + 0.5) / height) * Math.PI;
        directions.set([Math.sin(theta) * Math.cos(phi), Math.cos(theta), Math.sin(theta) * Math.sin(phi)], 3 * k);
    }
    const exact = await baker.filtered('phong-plain', 1, directions);
    let squares = 0, weights = 0, most = 0;
    errors.forEach((_, k) => {
        const error = (luminance(...irradianceOverPi(sh, directions[3 * k]!, directions[3 * k + 1]!, directions[3 * k + 2]!)) - luminance(exact[3 * k]!, exact[3 * k + 1]!, exact[3 * k + 2]!)) / mean;
        const weight = Math.sin(((Math.floor(k / width) + 0.5) / height) * Math.PI);
        errors[k] = error;
        squares += weight * error * error;
        weights += weight;
        most = Math.max(most, Math.abs(error));
    });
    return {width, height, errors, rms: Math.sqrt(squares / weights), most};
}
