import type {BakeOptions, Environment, ReadOptions} from './index.js';

/** What is used of Babylon.js, whichever of its packages it comes from. */
export interface BabylonClasses<Texture> {
    RawCubeTexture: new (...args: any[]) => Texture;
    SphericalPolynomial: {FromArray(data: number[][]): unknown};
}

/**
 * Filters an environment exactly, in a worker, with the diffuse light as a polynomial. For left-handed and right-handed scenes.
 *
 *     import * as BABYLON from '@babylonjs/core';
 *     scene.environmentTexture = await bakeEnvironment(scene, file, {BABYLON});
 *
 * source: a file, a cube texture of floats or half floats of Babylon.js, or an Environment.
 * size: 256 if left out; a power of two. BABYLON: if left out, the global one of a script.
 */
export function bakeEnvironment<Texture = any>(
    scene: {useRightHandedSystem: boolean; getEngine(): unknown},
    source: string | URL | Blob | Response | ArrayBuffer | ArrayBufferView | {getInternalTexture(): unknown} | Environment,
    options?: Omit<BakeOptions, 'engine' | 'encoding' | 'levels' | 'layout' | 'shBands'> & {file?: ReadOptions; BABYLON?: BabylonClasses<Texture>},
): Promise<Texture>;
