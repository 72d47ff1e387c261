// What the page wants to know of the picture: its displayed values, its objects, and the surface at a pixel.

import * as THREE from 'three';
import type {State} from '../state';
import {readBytes} from './read_back';
import type {Stage} from './stage';

export class Inspector {
    private readonly pixel = new THREE.WebGLRenderTarget(1, 1, {type: THREE.FloatType});

    constructor(private readonly stage: Stage) {}

    /// A side as the screen shows it: RGBA bytes, rows from the top.
    displayed(state: State, index: number): Promise<Uint8Array<ArrayBuffer>> {
        const {stage} = this, {width, height} = stage.panes[0], target = new THREE.WebGLRenderTarget(width, height, {depthBuffer: false});
        const u = stage.present.uniforms;
        u.u_left!.value = stage.side(state, index);
        u.u_divider!.value = 2;
        u.u_view!.value = 0;
        stage.setDisplay(u, state);
        stage.present.run(stage.renderer, target);
        return readBytes(stage, target);
    }
    /// The number of the object in each pixel, rows from the top.
    async objects(): Promise<Uint16Array<ArrayBuffer>> {
        const {stage} = this, {width, height} = stage.panes[0], target = new THREE.WebGLRenderTarget(width, height);
        stage.look(0, 0, width, height);
        stage.drawFor('identify', target);
        const bytes = await readBytes(stage, target);
        return Uint16Array.from({length: width * height}, (_, k) => bytes[4 * k]! + 256 * bytes[4 * k + 1]!);
    }

    /// The normal and the roughness at a pixel; null where no surface is.
    async probe(x: number, y: number): Promise<{normal: THREE.Vector3; roughness: number} | null> {
        const {stage} = this, values = new Float32Array(4);
        stage.look(x, y, 1, 1);
        stage.drawFor('probe', this.pixel);
        await stage.renderer.readRenderTargetPixelsAsync(this.pixel, 0, 0, 1, 1, values);
        return values[3]! > 0 ? {normal: new THREE.Vector3().fromArray(values), roughness: values[3]!} : null;
    }
}
