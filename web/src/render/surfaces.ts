// Materials of glTF as the uniforms and defines of shading/surface.glsl.

import * as THREE from 'three';
import {modelProgram, type Purpose} from './programs';

export type Uniforms = Record<string, THREE.IUniform>;

interface Surface {
    uniforms: Uniforms;
    defines: Record<string, string>;
}

/// What an object reads in place of the environment.
export interface LiveMaps {
    u_specular: THREE.Texture;
    u_irradiance: THREE.Texture;
    u_last_level: number;
    u_sh: THREE.Vector3[];
}
const liveNames = ['u_specular', 'u_irradiance', 'u_last_level', 'u_sh'] as const;

/// One mesh with its own uniforms, and a material for each purpose, made when it is first drawn.
export class LitMesh {
    private readonly surface: Surface;
    private readonly materials = new Map<Purpose, THREE.RawShaderMaterial>();
    private readonly transparent: boolean;
    private live: LiveMaps | null = null;
    private readonly own: Uniforms = Object.fromEntries(liveNames.map(name => [name, {value: null}]));
    private readonly side: THREE.Side;

    constructor(
        readonly mesh: THREE.Mesh,
        source: THREE.MeshStandardMaterial,
        private readonly shared: Uniforms,
        /// From 1: 0 is the background.
        number: number,
    ) {
        this.surface = surfaceOf(mesh, source);
        this.surface.uniforms.u_object = {value: number};
        this.transparent = source.transparent;
        this.side = source.side;
    }

    get textures(): THREE.Texture[] {
        return Object.values(this.surface.uniforms).map(({value}) => value).filter(value => value instanceof THREE.Texture);
    }
    use(purpose: Purpose): void {
        let material = this.materials.get(purpose);
        if (!material) this.materials.set(purpose, (material = this.make(purpose)));
        this.mesh.material = material;
        const live = purpose === 'split-sum' || purpose === 'stretched' ? this.live : null;
        for (const name of liveNames) this.own[name]!.value = live ? live[name] : this.shared[name]!.value;
    }

    /// null: the environment alone. The maps are disposed of with the mesh.
    setLive(maps: LiveMaps | null): void {
        this.live?.u_specular.dispose();
        this.live?.u_irradiance.dispose();
        this.live = maps;
    }
    /// The mesh has been moved.
    place(): void {
        (this.surface.uniforms.u_normal_matrix!.value as THREE.Matrix3).getNormalMatrix(this.mesh.matrixWorld);
    }
    get centre(): THREE.Vector3 {
        const {geometry, matrixWorld} = this.mesh;
        if (!geometry.boundingSphere) geometry.computeBoundingSphere();
        return geometry.boundingSphere!.center.clone().applyMatrix4(matrixWorld);
    }
    get radius(): number {
        return (this.mesh.geometry.boundingSphere?.radius ?? 0) * this.mesh.matrixWorld.getMaxScaleOnAxis();
    }

    /// whole: also what another set of materials of the same model would still need.
    dispose(whole: boolean): void {
        for (const material of this.materials.values()) material.dispose();
        this.setLive(null);
        if (!whole) return;
        this.mesh.geometry.dispose();
        for (const texture of this.textures) texture.dispose();
    }

    private make(purpose: Purpose): THREE.RawShaderMaterial {
        const blended = this.transparent && purpose !== 'probe' && purpose !== 'identify';
        return new THREE.RawShaderMaterial({
            ...modelProgram(purpose),
            glslVersion: THREE.GLSL3,
            uniforms: {...this.shared, ...this.surface.uniforms, ...this.own},
            defines: this.surface.defines,
            side: this.side,
            transparent: blended,
            depthWrite: !blended,
        });
    }
}

/// All materials of a model, one for each mesh. A mesh of several materials is drawn with its first.
export function litMeshes(root: THREE.Object3D, shared: Uniforms): LitMesh[] {
    root.updateMatrixWorld(true);
    const meshes: LitMesh[] = [];
    root.traverse(object => {
        const mesh = object as THREE.Mesh;
        if (!mesh.isMesh) return;
        const material = Array.isArray(mesh.material) ? mesh.material[0]! : mesh.material;
        meshes.push(new LitMesh(mesh, material as THREE.MeshStandardMaterial, shared, meshes.length + 1));
    });
    return meshes;
}

function surfaceOf(mesh: THREE.Mesh, source: THREE.MeshStandardMaterial): Surface {
    const physical = source as THREE.MeshPhysicalMaterial;
    const unlit = (source as unknown as THREE.MeshBasicMaterial).isMeshBasicMaterial === true;
    const uniforms: Uniforms = {
        u_normal_matrix: {value: new THREE.Matrix3().getNormalMatrix(mesh.matrixWorld)},
        u_base_color: {value: new THREE.Vector4(source.color.r, source.color.g, source.color.b, source.opacity)},
        u_metalness: {value: source.metalness ?? 0},
        u_roughness: {value: source.roughness ?? 1},
        u_emission: {value: emissionOf(source)},
        u_ior: {value: physical.ior ?? 1.5},
        u_specular_weight: {value: physical.specularIntensity ?? 1},
        u_specular_tint: {value: physical.specularColor ?? new THREE.Color(1, 1, 1)},
        u_normal_scale: {value: source.normalScale?.x ?? 1},
        u_occlusion_strength: {value: source.aoMapIntensity ?? 1},
        u_alpha_cutoff: {value: source.alphaTest > 0 ? source.alphaTest : -1},
        u_blend: {value: source.transparent},
        u_unlit: {value: unlit},
    };
    const defines: Record<string, string> = {};
    const has = (name: string) => mesh.geometry.hasAttribute(name);
    if (has('uv')) defines.HAS_UV = '';
    if (has('uv1')) defines.HAS_UV1 = '';
    if (has('tangent')) defines.HAS_TANGENT = '';
    if (has('color') && source.vertexColors) defines.HAS_COLOR = '';
    if (!has('normal')) flatten(mesh);
    const map = (name: string, texture: THREE.Texture | null | undefined) => {
        if (!texture || !has(texture.channel === 1 ? 'uv1' : 'uv')) return;
        texture.updateMatrix();
        defines[name.toUpperCase()] = texture.channel === 1 ? 'v_uv1' : 'v_uv';
        uniforms[`u_${name}`] = {value: texture};
        uniforms[`u_${name}_uv`] = {value: texture.matrix};
    };
    map('base_color_map', source.map);
    map('metallic_roughness_map', source.roughnessMap ?? source.metalnessMap);
    map('normal_map', source.normalMap);
    map('occlusion_map', source.aoMap);
    map('emission_map', source.emissiveMap);
    return {uniforms, defines};
}

/// glTF 2.0, 3.7.2.1: without normals, each triangle has its own.
function flatten(mesh: THREE.Mesh): void {
    if (mesh.geometry.index) mesh.geometry = mesh.geometry.toNonIndexed();
    mesh.geometry.computeVertexNormals();
}

function emissionOf(source: THREE.MeshStandardMaterial): THREE.Vector3 {
    const {emissive} = source, intensity = source.emissiveIntensity ?? 1;
    return emissive ? new THREE.Vector3(emissive.r, emissive.g, emissive.b).multiplyScalar(intensity) : new THREE.Vector3();
}
