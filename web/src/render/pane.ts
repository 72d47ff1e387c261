// One picture that becomes better while nothing moves: the mean of frames whose pixels are sampled at different points.

import * as THREE from 'three';
import {floatTarget, Pass} from './passes';
import {accumulateProgram} from './programs';

/// A point of the Halton sequence in bases 2 and 3.
function halton(index: number): [number, number] {
    const digits = (base: number) => {
        let sum = 0, digit = 1 / base;
        for (let rest = index; rest > 0; rest = Math.floor(rest / base), digit /= base) sum += digit * (rest % base);
        return sum;
    };
    return [digits(2), digits(3)];
}

export class Pane {
    /// Frames in the mean.
    count = 0;
    private mean: THREE.WebGLRenderTarget;
    private next: THREE.WebGLRenderTarget;
    private readonly frame: THREE.WebGLRenderTarget;
    private readonly smooth: THREE.WebGLRenderTarget;
    readonly add = new Pass(accumulateProgram, {u_mean: {value: null}, u_picture: {value: null}, u_weight: {value: 1}});

    constructor(private readonly renderer: THREE.WebGLRenderer) {
        this.mean = floatTarget(1, 1);
        this.next = floatTarget(1, 1);
        this.frame = floatTarget(1, 1, {depthBuffer: true});
        this.smooth = floatTarget(1, 1, {depthBuffer: true, type: THREE.HalfFloatType, samples: 4});
    }

    get target(): THREE.WebGLRenderTarget {
        return this.mean;
    }
    get width(): number {
        return this.mean.width;
    }
    get height(): number {
        return this.mean.height;
    }

    resize(width: number, height: number): void {
        for (const target of [this.mean, this.next, this.frame, this.smooth]) target.setSize(width, height);
        this.count = 0;
    }

    /// Draws one more frame. `look` points the camera, moved by a part of a pixel; `draw` renders the scene into the current target; noisy: do
    /// not spend time on the edges of its first frame.
    advance(look: (x: number, y: number) => void, noisy: boolean, draw: () => void): void {
        const first = this.count === 0 && !noisy, target = first ? this.smooth : this.frame;
        const [x, y] = halton(this.count);
        look(first ? 0 : x - 0.5, first ? 0 : y - 0.5);
        this.renderer.setRenderTarget(target);
        draw();
        Object.assign(this.add.uniforms, {u_mean: {value: this.mean.texture}, u_picture: {value: target.texture}, u_weight: {value: 1 / ++this.count}});
        this.add.run(this.renderer, this.next);
        [this.mean, this.next] = [this.next, this.mean];
    }

    dispose(): void {
        for (const target of [this.mean, this.next, this.frame, this.smooth]) target.dispose();
    }
}
