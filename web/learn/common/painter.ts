// Shaders, run for each pixel of a canvas of the page, or of a small table of numbers. The page does not wait for the graphics card: pictures and numbers are taken
// from it when they are done.

import * as THREE from 'three';
import {Backlog} from '../../src/render/backlog';
import {floatTarget, type Pass} from '../../src/render/passes';

/// What a drawing throws that has to begin anew, because something else was chosen meanwhile.
export class Outdated extends Error {}

export class Painter {
    readonly renderer: THREE.WebGLRenderer;
    private readonly backlog: Backlog;
    private readonly targets = new Map<string, THREE.WebGLRenderTarget>();
    private readonly compiled = new Set<Pass>();

    /// outdated: whether what is being drawn has to begin anew.
    constructor(private readonly outdated: () => boolean) {
        this.renderer = new THREE.WebGLRenderer({canvas: document.createElement('canvas'), antialias: false, depth: false, stencil: false, alpha: true, premultipliedAlpha: false, preserveDrawingBuffer: true});
        this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shaders write what the screen shows
        this.backlog = new Backlog(this.renderer);
        this.renderer.domElement.addEventListener('webglcontextrestored', () => this.backlog.forget());
    }

    /// Draws into a canvas, which takes this size.
    async paint(canvas: HTMLCanvasElement, pass: Pass, width: number, height: number): Promise<CanvasRenderingContext2D> {
        await this.compile(pass);
        this.renderer.setSize(width, height, false);
        pass.run(this.renderer, null);
        await this.finish();
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
        const context = canvas.getContext('2d')!;
        context.clearRect(0, 0, width, height);
        context.drawImage(this.renderer.domElement, 0, 0);
        return context;
    }

    /// Runs a shader for a table of numbers: RGBA floats, the row at gl_FragCoord.y = 0.5 first.
    async compute(pass: Pass, width: number, height: number): Promise<Float32Array> {
        const target = this.target(width, height), values = new Float32Array(4 * width * height);
        await this.run(pass, target);
        this.renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
        return values;
    }

    /// Runs a shader for each pixel of a target.
    async run(pass: Pass, target: THREE.WebGLRenderTarget): Promise<void> {
        await this.compile(pass);
        pass.run(this.renderer, target);
        await this.finish();
    }

    /// Waits until the card has done what it was given.
    async finish(): Promise<void> {
        this.backlog.mark();
        await this.backlog.emptied();
        this.check();
    }
    /// Lets the page do what has come up during a long computation.
    async pause(): Promise<void> {
        await new Promise(resolve => setTimeout(resolve));
        this.check();
    }
    /// Ends a drawing that has to begin anew.
    check(): void {
        if (this.outdated() || this.renderer.getContext().isContextLost()) throw new Outdated();
    }

    private async compile(pass: Pass): Promise<void> {
        if (!this.compiled.has(pass)) await pass.compile(this.renderer);
        this.compiled.add(pass);
        this.check();
    }
    /// A target of floats that is kept for tables of its size.
    private target(width: number, height: number): THREE.WebGLRenderTarget {
        const key = `${width} ${height}`;
        let target = this.targets.get(key);
        if (!target) this.targets.set(key, (target = floatTarget(width, height)));
        return target;
    }
}
