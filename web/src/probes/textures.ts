// A set of probes as textures and uniforms of shading/probe_*.glsl.

import * as THREE from 'three';
import type {Uniforms} from '../render/surfaces';
import type {Atlas} from './atlas';
import {k_cells_width} from './cells';
import type {ProbeSet} from './load';
import type {Probe} from './record';

/// Columns of the table of probes, as shading/probe_records.glsl reads them.
const k_columns = 14;
const k_most_levels = 16;
const shapes = ['everywhere', 'box', 'sphere'];
/// What the cosine lobe leaves of a harmonic's band: Ramamoorthi and Hanrahan 2001, eq. 7 to 9, over pi.
const cosineFactors = [1, 2 / 3, 2 / 3, 2 / 3, 1 / 4, 1 / 4, 1 / 4, 1 / 4, 1 / 4];

export const probeUniforms = (): Uniforms => ({
    u_probe_records: {value: null}, u_probe_count: {value: 0}, u_probe_grid: {value: false}, u_probe_origin: {value: new THREE.Vector3()},
    u_probe_spacing: {value: new THREE.Vector3(1, 1, 1)}, u_probe_counts: {value: new THREE.Vector3(1, 1, 1)},
    u_probe_distances: {value: null}, u_probe_cells: {value: null}, u_probe_distance_size: {value: 0}, u_probe_specular: {value: null}, u_probe_irradiance: {value: null},
    u_probe_irradiance_size: {value: 1}, u_probe_levels: {value: Array.from({length: k_most_levels}, () => new THREE.Vector3())}, u_probe_last_level: {value: 0},
    u_probe_most: {value: 8}, u_probe_use_visibility: {value: true}, u_probe_use_all: {value: false}, u_probe_parallax: {value: true},
});

/// Gives a set to the uniforms. most: layers that a texture can have; a larger set is refused by a sentence.
export function setProbeUniforms(uniforms: Uniforms, {record, maps}: ProbeSet, most: number): void {
    const {probes, grid, roughness} = record;
    if (probes.length > most) throw new Error(`The set has ${probes.length} probes, and this graphics card takes ${most}.`);
    if (roughness.length > k_most_levels) throw new Error(`The set has ${roughness.length} levels of roughness, and the page reads ${k_most_levels}.`);
    const replace = (name: string, texture: THREE.Texture | null) => {
        (uniforms[name]!.value as THREE.Texture | null)?.dispose();
        uniforms[name]!.value = texture;
    };
    replace('u_probe_specular', atlasTexture(maps.specular));
    replace('u_probe_irradiance', atlasTexture(maps.irradiance));
    replace('u_probe_records', recordTexture(probes));
    const {distances, cells} = maps;
    replace('u_probe_distances', distances ? floatLayers(distances.texels, distances.width, distances.height, distances.layers) : floatLayers(new Float32Array(4), 1, 1, 1));
    replace('u_probe_cells', cells ? floatLayers(cells.texels, k_cells_width, cells.height, cells.layers) : floatLayers(new Float32Array(4), 1, 1, 1));
    maps.specular.levels.forEach(({size, top}, l) => (uniforms.u_probe_levels!.value as THREE.Vector3[])[l]!.set(size, top, roughness[l]!));
    const values = {
        u_probe_count: probes.length, u_probe_grid: grid !== null, u_probe_distance_size: distances?.size ?? 0, u_probe_irradiance_size: record.irradiance.size, u_probe_last_level: roughness.length - 1,
    };
    for (const [name, value] of Object.entries(values)) uniforms[name]!.value = value;
    if (!grid) return;
    (uniforms.u_probe_origin!.value as THREE.Vector3).fromArray(grid.origin);
    (uniforms.u_probe_spacing!.value as THREE.Vector3).fromArray(grid.spacing);
    (uniforms.u_probe_counts!.value as THREE.Vector3).fromArray(grid.counts);
}

function floatLayers(texels: Float32Array, width: number, height: number, layers: number): THREE.DataArrayTexture {
    const texture = new THREE.DataArrayTexture(texels as Float32Array<ArrayBuffer>, width, height, layers);
    texture.format = THREE.RGBAFormat;
    texture.type = THREE.FloatType;
    texture.needsUpdate = true;
    return texture;
}

function atlasTexture({texels, width, height, layers}: Atlas): THREE.DataArrayTexture {
    const texture = new THREE.DataArrayTexture(texels as never, width, height, layers);
    texture.format = texels instanceof Uint32Array ? THREE.RGBFormat : THREE.RGBAFormat;
    texture.type = texels instanceof Uint32Array ? THREE.UnsignedInt5999Type : THREE.HalfFloatType;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

function recordTexture(probes: Probe[]): THREE.DataTexture {
    const table = new Float32Array(4 * k_columns * probes.length);
    probes.forEach((probe, row) => {
        const {influence, proxy} = probe, put = (column: number, ...values: number[]) => table.set(values, 4 * (row * k_columns + column));
        put(0, ...probe.position, probe.valid ? 1 : 0);
        put(1, ...(proxy?.low ?? [0, 0, 0]), proxy ? 1 : 0);
        put(2, ...(proxy?.high ?? [0, 0, 0]), shapes.indexOf(influence.shape));
        put(3, ...(influence.box?.low ?? [influence.radius, 0, 0]), influence.fade);
        put(4, ...(influence.box?.high ?? [0, 0, 0]), 0);
        probe.harmonics.forEach((c, k) => put(5 + k, ...c.map(v => v * cosineFactors[k]!)));
    });
    const texture = new THREE.DataTexture(table, k_columns, probes.length, THREE.RGBAFormat, THREE.FloatType);
    texture.needsUpdate = true;
    return texture;
}
