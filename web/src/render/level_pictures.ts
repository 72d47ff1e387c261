// Levels of the baked maps as small pictures.

import * as THREE from 'three';
import type {State} from '../state';
import {Pass} from './passes';
import {levelProgram} from './programs';
import {readBytes} from './read_back';
import type {Stage} from './stage';

export const shapes = ['ball', 'faces', 'latlong'] as const;
export type Shape = (typeof shapes)[number];

/// Pixels of such a picture.
export function sizeOf(shape: Shape): {width: number; height: number} {
    return shape === 'ball' ? {width: 128, height: 128} : {width: 192, height: shape === 'faces' ? 128 : 96};
}

export interface LevelOptions {
    map: 'specular' | 'phong' | 'irradiance' | 'sh';
    level: number;
    shape: Shape;
}

export class LevelPictures {
    private readonly pass: Pass;

    constructor(private readonly stage: Stage) {
        const u = stage.uniforms;
        this.pass = new Pass(levelProgram, {
            u_environment: {value: new THREE.Matrix3()}, u_sh: u.u_sh!, u_specular: u.u_specular!, u_irradiance: u.u_irradiance!, u_brdf: u.u_brdf!,
            u_last_level: u.u_last_level!, u_latlong: u.u_latlong!, u_turn: u.u_turn!, u_cube: {value: null}, u_level: {value: 0}, u_scale: {value: 1},
            u_by_harmonics: {value: false}, u_shape: {value: 0}, u_tonemap: {value: 0}, u_exposure: {value: 1},
        });
    }

    async draw(canvas: HTMLCanvasElement, state: State, {map, level, shape}: LevelOptions): Promise<void> {
        const {width, height} = sizeOf(shape), u = this.pass.uniforms;
        u.u_cube!.value = this.stage.uniforms[map === 'phong' ? 'u_phong' : map === 'specular' ? 'u_specular' : 'u_irradiance']!.value;
        if (!u.u_cube!.value) return;
        u.u_level!.value = level;
        u.u_scale!.value = map === 'irradiance' ? 1 / Math.PI : 1;
        u.u_by_harmonics!.value = map === 'sh';
        u.u_shape!.value = shapes.indexOf(shape);
        this.stage.setDisplay(u, state);
        const target = new THREE.WebGLRenderTarget(width, height, {depthBuffer: false});
        this.pass.run(this.stage.renderer, target);
        const bytes = await readBytes(this.stage, target);
        Object.assign(canvas, {width, height});
        canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer), width, height), 0, 0);
    }
}
