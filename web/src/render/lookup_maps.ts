// The environment as the textures of reflection mapping: lat-long, sphere map, dual paraboloid.

import * as THREE from 'three';
import type {State} from '../state';
import {floatTarget, Pass} from './passes';
import {projectProgram} from './programs';

interface Maps {
    front: THREE.Texture | null;
    back: THREE.Texture | null;
}

export class LookupMaps {
    private readonly pass: Pass;
    private readonly made = new Map<string, {maps: Maps; targets: THREE.WebGLRenderTarget[]}>();

    constructor(
        private readonly renderer: THREE.WebGLRenderer,
        private readonly latlong: THREE.IUniform,
    ) {
        this.pass = new Pass(projectProgram, {u_latlong: latlong, u_turn: {value: new THREE.Matrix3()}, u_projection: {value: 0}});
    }

    /// The maps of a lookup, drawn when they are first asked for. size: the height of a lat-long map, the width of each disc.
    get(lookup: State['lookup'], size: number): Maps {
        const projections = {environment: [], cube: [], latlong: [2], 'sphere-map': [3], 'dual-paraboloid': [4, 5]}[lookup];
        if (projections.length === 0 || !this.latlong.value) return {front: null, back: null};
        const key = `${lookup} ${size}`;
        let entry = this.made.get(key);
        if (!entry) {
            const targets = projections.map(projection => this.draw(projection, lookup === 'latlong' ? 2 * size : size, size));
            entry = {targets, maps: {front: targets[0]!.texture, back: targets.at(-1)!.texture}};
            this.made.set(key, entry);
        }
        return entry.maps;
    }

    /// Of another environment.
    forget(): void {
        for (const {targets} of this.made.values()) for (const target of targets) target.dispose();
        this.made.clear();
    }

    private draw(projection: number, width: number, height: number): THREE.WebGLRenderTarget {
        const target = floatTarget(width, height, {
            type: THREE.HalfFloatType, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter,
            wrapS: projection === 2 ? THREE.RepeatWrapping : THREE.ClampToEdgeWrapping,
        });
        this.pass.uniforms.u_projection!.value = projection;
        this.pass.run(this.renderer, target);
        return target;
    }
}
