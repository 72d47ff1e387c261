// What each object sees of its neighbours: a cube that is drawn from its middle, filtered in the worker like an environment, and read by the object in its place.

import * as THREE from 'three';
import type {Baker} from '../bake/baker';
import {cubeTexture} from './maps';
import {floatTarget} from './passes';
import type {Stage} from './stage';
import type {LitMesh} from './surfaces';

const k_face = 64;
/// Of a model with more objects, the largest see their neighbours.
const k_most_objects = 32;
/// How often each object looks around after something has changed: the second time it sees its neighbours lit by it.
const k_rounds = 2;

export class LiveCubes {
    private readonly target = floatTarget(k_face, 6 * k_face, {depthBuffer: true});
    private busy = false;
    private next = 0;
    private left = 0;
    /// Milliseconds from the drawing of the last cube to its use, and in the worker.
    readonly timings = {all: 0, bake: 0};

    constructor(
        private readonly stage: Stage,
        private readonly baker: Baker,
    ) {}

    /// Something that objects see has changed.
    invalidate(): void {
        this.left = k_rounds * this.objects.length;
    }
    /// Objects see the environment alone again.
    clear(): void {
        this.left = 0;
        for (const object of this.stage.objects) object.setLive(null);
    }
    get done(): boolean {
        return this.left <= 0;
    }

    /// Called after a frame: has the next object look around, unless the worker is still busy with another. Whether the picture has changed.
    async step(): Promise<boolean> {
        const {objects} = this;
        if (this.busy || this.done || objects.length === 0) return false;
        this.busy = true;
        const object = objects[this.next++ % objects.length]!, start = performance.now(), texels = new Float32Array(4 * 6 * k_face * k_face);
        try {
            this.stage.drawCube(this.target, k_face, object);
            await this.stage.renderer.readRenderTargetPixelsAsync(this.target, 0, 0, k_face, 6 * k_face, texels);
            const bake = await this.baker.live(k_face, texels);
            object.setLive({
                u_specular: cubeTexture(bake.specular.levels), u_irradiance: cubeTexture([bake.irradiance]), u_last_level: bake.specular.levels.length - 1,
                u_sh: Array.from({length: 9}, (_, k) => new THREE.Vector3().fromArray(bake.sh, 3 * k)),
            });
            Object.assign(this.timings, {all: performance.now() - start, bake: bake.milliseconds});
            --this.left;
        } finally {
            this.busy = false;
        }
        return true;
    }

    private get objects(): LitMesh[] {
        const all = [...this.stage.objects];
        return all.length <= k_most_objects ? all : all.sort((a, b) => b.radius - a.radius).slice(0, k_most_objects);
    }
}
