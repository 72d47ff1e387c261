// Shaders, run for each pixel of a canvas of the page, or of a small table of numbers.

import * as THREE from 'three';
import {floatTarget, type Pass} from '../../src/render/passes';

export class Painter {
    readonly renderer: THREE.WebGLRenderer;
    private readonly targets = new Map<string, THREE.WebGLRenderTarget>();

    constructor() {
        this.renderer = new THREE.WebGLRenderer({canvas: document.createElement('canvas'), antialias: false, depth: false, stencil: false, alpha: true, premultipliedAlpha: false});
        this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shaders write what the screen shows
    }

    /// Draws into a canvas, which takes this size.
    paint(canvas: HTMLCanvasElement, pass: Pass, width: number, height: number): CanvasRenderingContext2D {
        this.renderer.setSize(width, height, false);
        pass.run(this.renderer, null);
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
        const context = canvas.getContext('2d')!;
        context.clearRect(0, 0, width, height);
        context.drawImage(this.renderer.domElement, 0, 0);
        return context;
    }

    /// Runs a shader for a table of numbers: RGBA floats, the row at gl_FragCoord.y = 0.5 first.
    compute(pass: Pass, width: number, height: number): Float32Array {
        const target = this.target(width, height), values = new Float32Array(4 * width * height);
        pass.run(this.renderer, target);
        this.renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
        return values;
    }

    /// A target of floats that is kept for tables of its size.
    private target(width: number, height: number): THREE.WebGLRenderTarget {
        const key = `${width} ${height}`;
        let target = this.targets.get(key);
        if (!target) this.targets.set(key, (target = floatTarget(width, height)));
        return target;
    }
}
