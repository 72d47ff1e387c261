import type {Texture as ThreeTexture, WebGLCubeRenderTarget, WebGLRenderer, WebGLRenderTarget} from 'three';
import type {BakeOptions, Environment, ReadOptions} from './index.js';

/**
 * Filters an environment exactly, in a worker, in place of PMREMGenerator. Needs three.js r187 or later.
 *
 *     scene.environment = await bakeEnvironment(renderer, file);
 *
 * renderer: only asked for pixels where `source` is a render target; otherwise it may be null.
 * source: a file, an equirectangular texture of HDRLoader or EXRLoader, a CubeTexture of floats or half floats, a render target of floats or half floats
 * (a cube, or an equirectangular picture), or an Environment.
 */
export function bakeEnvironment(
    renderer: WebGLRenderer | null,
    source: string | URL | Blob | Response | ArrayBuffer | ArrayBufferView | ThreeTexture | WebGLCubeRenderTarget | WebGLRenderTarget | Environment,
    options?: Omit<BakeOptions, 'engine' | 'encoding' | 'layout'> & {file?: ReadOptions},
): Promise<ThreeTexture>;
