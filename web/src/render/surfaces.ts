// Materials of glTF as the uniforms and defines of shading/surface.glsl.

import * as THREE from 'three';
import type {Mode} from '../state';
import {modelProgram} from './programs';

export type Uniforms = Record<string, THREE.IUniform>;

interface Surface {
    uniforms: Uniforms;
    defines: Record<string, string>;
}

/// One mesh with its own uniforms, and a material for each mode, made when it is first drawn.
export class LitMesh {
    private readonly surface: Surface;
    private readonly materials = new Map<Mode, THREE.RawShaderMaterial>();
    private readonly transparent: boolean;

    constructor(
        readonly mesh: THREE.Mesh,
        source: THREE.MeshStandardMaterial,
        private readonly shared: Uniforms,
    ) {
        this.surface = surfaceOf(mesh, source);
        this.transparent = source.transparent;
    }

    use(mode: Mode): void {
        let material = this.materials.get(mode);
        if (!material) this.materials.set(mode, (material = this.make(mode)));
        this.mesh.material = material;
    }

    dispose(): void {
        for (const material of this.materials.values()) material.dispose();
        this.mesh.geometry.dispose();
        for (const {value} of Object.values(this.surface.uniforms)) if (value instanceof THREE.Texture) value.dispose();
    }

    private make(mode: Mode): THREE.RawShaderMaterial {
        return new THREE.RawShaderMaterial({
            ...modelProgram(mode),
            glslVersion: THREE.GLSL3,
            uniforms: {...this.shared, ...this.surface.uniforms},
            defines: this.surface.defines,
            side: THREE.DoubleSide,
            transparent: this.transparent,
            depthWrite: !this.transparent,
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
        meshes.push(new LitMesh(mesh, material as THREE.MeshStandardMaterial, shared));
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
    if (!has('normal')) mesh.geometry.computeVertexNormals();
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

function emissionOf(source: THREE.MeshStandardMaterial): THREE.Vector3 {
    const {emissive} = source, intensity = source.emissiveIntensity ?? 1;
    return emissive ? new THREE.Vector3(emissive.r, emissive.g, emissive.b).multiplyScalar(intensity) : new THREE.Vector3();
}
