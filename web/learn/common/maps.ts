// Passes that most pages need: the environment as it is, and maps of exact values beside it.

import bilinear from '../../src/shading/bilinear.glsl?raw';
import environment from '../../src/shading/environment.glsl?raw';
import tonemap from '../../src/shading/tonemap.glsl?raw';
import * as THREE from 'three';
import type {Lobe} from '../../src/bake/types';
import {tableTexture} from '../../src/render/maps';
import {Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import {directionAt, vectorOf} from './direction';
import type {Light} from './light';
import map from './map.glsl?raw';
import showMap from './show_map.glsl?raw';

/// What the pages' own shaders stand behind.
export const mapParts = [environment, bilinear, tonemap, map];

/// Draws u_envmap.
export const mapPass = (light: Light): Pass => new Pass(fullscreen(...mapParts, showMap), {...light.uniforms, u_facing: {value: new THREE.Vector3()}, u_scale: {value: 1}});

/// The light of a lobe in the directions of the texels of a lat-long map, by the library. RGB of each, rows from the top.
export function filteredMap(light: Light, lobe: Lobe, parameter: number, height: number): Promise<Float32Array> {
    const width = 2 * height, directions = new Float64Array(3 * width * height);
    for (let y = 0, k = 0; y < height; ++y) for (let x = 0; x < width; ++x, k += 3) directions.set(vectorOf(directionAt([(x + 0.5) / width, (y + 0.5) / height])), k);
    return light.baker.filtered(lobe, parameter, directions);
}

export function mapTexture(rgb: Float32Array, height: number): THREE.DataTexture {
    const texels = new Float32Array((rgb.length / 3) * 4).fill(1);
    for (let k = 0; k < rgb.length / 3; ++k) texels.set(rgb.subarray(3 * k, 3 * k + 3), 4 * k);
    return tableTexture(texels, 2 * height, height);
}

export const luminance = (r: number, g: number, b: number): number => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/// Numbers as the pages write them: four digits.
export const digits = (value: number): string => (value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(2).replace('e-', ' · 10⁻').replace(/(\d+)$/, n => [...n].map(d => '⁰¹²³⁴⁵⁶⁷⁸⁹'[+d]).join('')) : value.toPrecision(4));
export const percent = (value: number): string => `${value > 0 ? '+' : value < 0 ? '−' : ''}${Math.abs(100 * value) < 0.01 ? '< 0.01' : Math.abs(100 * value).toPrecision(2)} %`.replace(/^[+−]?< /, '< ');
/// A mean with its standard error: the error has two digits, and the mean as many decimals.
export function withError(mean: number, error: number): string {
    const decimals = error > 0 ? Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(error)))) : 4;
    return `${mean.toFixed(decimals)} ± ${error.toFixed(decimals)}`;
}
export function percentWithError(value: number, error: number): string {
    return `(${withError(100 * value, 100 * error).replace(/-/g, '−')}) %`;
}
