// Models from .glb and .gltf files, by three.js's loader.

import * as THREE from 'three';
import type {DRACOLoader} from 'three/addons/loaders/DRACOLoader.js';
import type {GLTF} from 'three/addons/loaders/GLTFLoader.js';
import type {KTX2Loader} from 'three/addons/loaders/KTX2Loader.js';
import type {Model} from './built_in';
import {undrawn} from './undrawn';

/// Reads a model. `siblings`: files that were dropped with it, by name, which a .gltf refers to.
/// base: the address of its folder, where it was not dropped. renderer: compressed textures become what it can show. Throws an Error with a sentence.
export async function loadModel(renderer: THREE.WebGLRenderer, name: string, bytes: ArrayBuffer, siblings: Map<string, File> = new Map(), base = ''): Promise<Model> {
    const {GLTFLoader} = await import('three/addons/loaders/GLTFLoader.js');
    const {MeshoptDecoder} = await import('three/addons/libs/meshopt_decoder.module.js');
    const manager = new THREE.LoadingManager();
    const urls: string[] = [], missing = new Set<string>();
    manager.onError = url => missing.add(decodeURIComponent(url.split('/').pop() ?? url));
    manager.setURLModifier(url => {
        const file = siblings.get(decodeURIComponent(url.split('/').pop() ?? ''));
        if (!file) return url;
        urls.push(URL.createObjectURL(file));
        return urls.at(-1)!;
    });
    const loader = new GLTFLoader(manager).setMeshoptDecoder(MeshoptDecoder), decoders = await decodersFor(bytes, manager, renderer);
    if (decoders.draco) loader.setDRACOLoader(decoders.draco);
    if (decoders.ktx2) loader.setKTX2Loader(decoders.ktx2);
    let gltf: GLTF;
    try {
        gltf = await loader.parseAsync(bytes, base);
    } catch (error) {
        const incomplete = /Failed to load buffer|Couldn't load texture/.test(sentence(error));
        throw new Error(incomplete ? `${name}: ${sentence(error)}. Open it together with the files that it names, or drop its folder.` : `${name}: the model cannot be read (${sentence(error)}).`);
    } finally {
        urls.forEach(URL.revokeObjectURL);
        decoders.draco?.dispose();
        decoders.ktx2?.dispose();
    }
    if (!gltf.scene || !hasSurface(gltf.scene)) throw new Error(`${name}: the model has no surface to be lit.`);
    freeze(gltf.scene);
    gltf.scene.userData.luxPerUnit = gltf.asset.extras?.lux_per_unit;
    gltf.scene.traverse(object => (object.userData.sourceMaterial = (object as THREE.Mesh).material));
    return {name, root: gltf.scene, variants: variantsOf(gltf), useVariant: index => useVariant(gltf, index), notes: [...undrawn(gltf.parser.json), ...(missing.size > 0 ? [`${[...missing].join(', ')} ${missing.size > 1 ? 'are' : 'is'} missing: open the model together with the files that it names, or drop its folder.`] : [])]};
}

interface Decoders {
    draco?: DRACOLoader;
    ktx2?: KTX2Loader;
}

/// Draco's and Basis Universal's decoders are large, and fetched for the models that need them.
async function decodersFor(bytes: ArrayBuffer, manager: THREE.LoadingManager, renderer: THREE.WebGLRenderer): Promise<Decoders> {
    const glb = new DataView(bytes), isGlb = bytes.byteLength >= 20 && glb.getUint32(0, true) === 0x46546c67;
    const text = new TextDecoder().decode(isGlb ? new Uint8Array(bytes, 20, Math.min(glb.getUint32(12, true), bytes.byteLength - 20)) : bytes), made: Decoders = {};
    if (text.includes('KHR_draco_mesh_compression')) {
        const [{DRACOLoader}, {default: js}, {default: wasm}] = await Promise.all([import('three/addons/loaders/DRACOLoader.js'),
            import('three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js?url'), import('three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?url')]);
        made.draco = new DRACOLoader(manager).setDecoderPath({js, wasm} as never).setWorkerLimit(2);
    }
    if (text.includes('KHR_texture_basisu')) {
        const {KTX2Loader} = await import('three/addons/loaders/KTX2Loader.js');
        made.ktx2 = new KTX2Loader(manager).setWorkerLimit(2).detectSupport(renderer);
    }
    return made;
}

const sentence = (error: unknown) => String((error as Error).message ?? error).replace(/^THREE\.\w+: /, '').replace(/\.$/, '');

function hasSurface(root: THREE.Object3D): boolean {
    let found = false;
    root.traverse(object => (found ||= (object as THREE.Mesh).isMesh === true));
    return found;
}

/// Bones and morph targets in the pose that the file shows become plain vertices: nothing moves here.
function freeze(root: THREE.Object3D): void {
    root.updateMatrixWorld(true);
    root.traverse(object => {
        const mesh = object as THREE.SkinnedMesh;
        if (!mesh.isMesh || !(mesh.isSkinnedMesh || mesh.morphTargetInfluences?.some(w => w !== 0))) return;
        const geometry = mesh.geometry.clone(), place = geometry.getAttribute('position'), point = new THREE.Vector3();
        for (let k = 0; k < place.count; ++k) {
            mesh.getVertexPosition(k, point);
            place.setXYZ(k, point.x, point.y, point.z);
        }
        geometry.morphAttributes = {};
        geometry.computeVertexNormals();
        mesh.geometry = geometry;
    });
}

function variantsOf(gltf: GLTF): string[] {
    const extension = gltf.parser.json.extensions?.KHR_materials_variants;
    return (extension?.variants ?? []).map((variant: {name: string}) => variant.name);
}

interface VariantMapping {
    material: number;
    variants: number[];
}

/// KHR_materials_variants.
async function useVariant(gltf: GLTF, index: number | null): Promise<void> {
    const meshes: THREE.Mesh[] = [];
    gltf.scene.traverse(object => (object as THREE.Mesh).isMesh && meshes.push(object as THREE.Mesh));
    // All together at the end: a frame that is drawn in between gives the meshes back the materials of the page.
    const materials = await Promise.all(meshes.map(async mesh => {
        const mappings: VariantMapping[] = mesh.userData.gltfExtensions?.KHR_materials_variants?.mappings ?? [];
        const mapping = index === null ? undefined : mappings.find(({variants}) => variants.includes(index));
        return mapping ? gltf.parser.getDependency('material', mapping.material) : mesh.userData.sourceMaterial;
    }));
    meshes.forEach((mesh, k) => (mesh.material = materials[k]!));
}
