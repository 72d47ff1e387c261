// Balls of white metal by Monte Carlo and by split-sum, and numbers of one of their points.

import * as THREE from 'three';
import sampleEnvmap from '../../../docs/shaders/sample_envmap.glsl?raw';
import sphericalEnvmap from '../../../docs/shaders/spherical_envmap.glsl?raw';
import {Pass} from '../../src/render/passes';
import {fullscreen, ownFrame} from '../../src/render/program';
import type {Uniforms} from '../../src/render/surfaces';
import {radians} from '../../src/scene/framing';
import bilinear from '../../src/shading/bilinear.glsl?raw';
import brdf from '../../src/shading/brdf.glsl?raw';
import material from '../../src/shading/material.glsl?raw';
import monteCarlo from '../../src/shading/monte_carlo.glsl?raw';
import tonemap from '../../src/shading/tonemap.glsl?raw';
import ball from './ball.glsl?raw';
import type {Light} from './light';
import {luminance} from './maps';
import show from './show.glsl?raw';
import whiteMetal from './white_metal.glsl?raw';

/// The text in front of what uses the functions of monte_carlo.glsl.
export const monteCarloParts = [ownFrame(sphericalEnvmap), sampleEnvmap, bilinear, material, brdf, monteCarlo, whiteMetal];

export const ballUniforms = (): Uniforms => ({
    u_normal: {value: new THREE.Vector3()}, u_ball_roughness: {value: 0.3}, u_what: {value: 0},
});

/// strategy: 0 both, 1 the environment, 2 the BRDF.
export function monteCarloPass(light: Light, shared: Uniforms, strategy: number): Pass {
    return new Pass(fullscreen(...monteCarloParts, ball), {...light.uniforms, ...shared, u_strategy: {value: strategy}, u_tables: {value: 1}, u_samples: {value: 1}, u_frame: {value: 0}});
}
export const ballPass = (light: Light, shared: Uniforms, ...method: string[]): Pass => new Pass(fullscreen(...method, whiteMetal, ball), {...light.uniforms, ...shared});

export function showPass(light: Light): Pass {
    return new Pass(fullscreen(tonemap, show), {u_tonemap: light.uniforms.u_tonemap!, u_exposure: light.uniforms.u_exposure!, u_picture: {value: null}, u_other: {value: null}, u_difference: {value: false}});
}

/// The normal that the viewer at +Z sees at this cosine, turned around the ball's middle; 90 degrees is its top.
export function normalAt(NdotV: number, aroundDeg: number): [number, number, number] {
    const side = Math.sqrt(1 - NdotV * NdotV), a = radians(aroundDeg);
    return [side * Math.cos(a), side * Math.sin(a), NdotV];
}

/// Mean and standard deviation of the luminance in a table of estimates.
export function statistics(table: Float32Array): {mean: number; deviation: number; count: number} {
    let sum = 0, squares = 0, count = 0;
    for (let k = 0; k < table.length; k += 4, ++count) {
        const l = luminance(table[k]!, table[k + 1]!, table[k + 2]!);
        sum += l;
        squares += l * l;
    }
    const mean = sum / count;
    return {mean, deviation: Math.sqrt(Math.max(0, squares / count - mean * mean) * (count / Math.max(1, count - 1))), count};
}
