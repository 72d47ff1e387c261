// Passes over the whole picture.

import * as THREE from 'three';
import type {Program} from './program';
import type {Uniforms} from './surfaces';

const camera = new THREE.Camera();

/// A shader that is run for each pixel of a target, or of the screen.
export class Pass {
    readonly material: THREE.RawShaderMaterial;
    private readonly scene = new THREE.Scene();

    constructor(program: Program, readonly uniforms: Uniforms) {
        this.material = new THREE.RawShaderMaterial({...program, glslVersion: THREE.GLSL3, uniforms, depthTest: false, depthWrite: false});
        this.scene.add(triangle(this.material));
    }
    compile(renderer: THREE.WebGLRenderer): Promise<void> {
        return compile(renderer, this.scene, camera);
    }
    run(renderer: THREE.WebGLRenderer, target: THREE.WebGLRenderTarget | null): void {
        renderer.setRenderTarget(target);
        renderer.render(this.scene, camera);
    }
}

/// Compiles the shaders of a scene beside the page, where the browser can; otherwise they are begun.
export async function compile(renderer: THREE.WebGLRenderer, scene: THREE.Scene, camera: THREE.Camera): Promise<void> {
    if (renderer.getContext().getSupportedExtensions()?.includes('KHR_parallel_shader_compile')) await renderer.compileAsync(scene, camera);
    else renderer.compile(scene, camera);
}

/// Three vertices without attributes: the vertex shaders place them.
export function triangle(material: THREE.Material): THREE.Mesh {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(9, 3));
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
}

export function floatTarget(width: number, height: number, options: THREE.RenderTargetOptions = {}): THREE.WebGLRenderTarget {
    return new THREE.WebGLRenderTarget(width, height, {
        type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, depthBuffer: false, ...options,
    });
}
