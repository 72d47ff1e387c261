import type {Environment, ReadOptions, Work} from './index.js';

/** What is used of PlayCanvas, besides its constants. */
export interface PlayCanvasClasses<Texture> {
    Texture: new (...args: any[]) => Texture;
}

/**
 * Filters an environment exactly, in a worker, in place of EnvLighting.generateAtlas.
 *
 *     import * as pc from 'playcanvas';
 *     app.scene.envAtlas = await bakeEnvironment(app.scene, file, {pc});
 *
 * source: a file, a lat-long texture of the loader of .hdr files, a cube texture or a render target of floats, half floats or RGBE, or an Environment.
 * pc: if left out, the global one of a script.
 */
export function bakeEnvironment<Texture = any>(
    scene: object,
    source: string | URL | Blob | Response | ArrayBuffer | ArrayBufferView | {readonly cubemap: boolean} | {readonly colorBuffer: unknown} | Environment,
    options?: Work & {file?: ReadOptions; pc?: PlayCanvasClasses<Texture>},
): Promise<Texture>;
