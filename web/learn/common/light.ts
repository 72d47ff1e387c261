// The environment of a page: what the shaders of the page read of it, and the worker that knows its exact integrals.

import * as THREE from 'three';
import {Baker} from '../../src/bake/baker';
import type {Latlong, Tables} from '../../src/bake/types';
import {openSource, type LightSource} from '../../src/light_source';
import {tableTexture} from '../../src/render/maps';
import type {Uniforms} from '../../src/render/surfaces';

/// All numbers of a page are of one map, which has at most this many rows.
export const k_rows = 256;

const uniform = <T>(value: T) => ({value});

export class Light {
    readonly baker = new Baker();
    name = '';
    /// Of the map as it was read.
    readHeight = 0;
    tables!: Tables;
    /// What passes may share. u_envmap: the map, in floats.
    readonly uniforms: Uniforms = {
        u_envmap: uniform(null), u_row_averages: uniform(null), u_total_average: uniform(1), u_columns: uniform(null), u_rows: uniform(null),
        // The frame of docs/shaders/spherical_envmap.glsl, for files of the convention `default` in a world with +Y up.
        u_envmap_frame: uniform(new THREE.Matrix3().set(-1, 0, 0, 0, 0, 1, 0, 1, 0)),
        u_turn: uniform(new THREE.Matrix3()), u_environment: uniform(new THREE.Matrix3()), u_tonemap: uniform(3), u_exposure: uniform(1),
    };

    /// Opens an environment. The worker keeps the map of at most k_rows rows too, so that its integrals are those of what the shaders read.
    async open(source: LightSource): Promise<void> {
        const info = await openSource(this.baker, await source('auto')), tables = await this.baker.tables(k_rows);
        if (info.height > k_rows) await this.baker.use(info.name, rgbOf(tables));
        this.name = info.name;
        this.readHeight = info.height;
        this.tables = tables;
        const {width, height} = tables;
        this.put('u_envmap', tableTexture(tables.texels, width, height));
        this.put('u_row_averages', tableTexture(tables.rowAverages, 1, height));
        this.put('u_columns', tableTexture(tables.columns, width, height));
        this.put('u_rows', tableTexture(tables.rows, 1, height));
        this.uniforms.u_total_average!.value = tables.totalAverage;
        this.uniforms.u_exposure!.value = this.mean > 0 ? 0.45 / this.mean : 1;
    }

    /// The mean luminance over the sphere: the mean of luminance times sin θ over the square is 2/π of it.
    get mean(): number {
        return (this.tables.totalAverage * Math.PI) / 2;
    }

    private put(name: string, texture: THREE.Texture): void {
        (this.uniforms[name]!.value as THREE.Texture | null)?.dispose();
        this.uniforms[name]!.value = texture;
    }
}

function rgbOf({width, height, texels}: Tables): Latlong {
    const pixels = new Float32Array(3 * width * height);
    for (let k = 0; k < width * height; ++k) pixels.set(texels.subarray(4 * k, 4 * k + 3), 3 * k);
    return {width, height, pixels};
}
