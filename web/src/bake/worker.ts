// The worker that reads and filters environments, so that the page keeps moving.

import {levelExponent, levelRoughness, sizesDownTo} from './chain';
import {Module, type Environment} from './module';
import {asLatlong, halfFloats, overEnvironment} from './latlong';
import {readPicture} from './read_picture';
import {drawSamples, makeTables, reduce, survey} from './tables';
import type {Bake, CubeLevel, EnvironmentInfo, Latlong, Replies, Request} from './types';
import moduleUrl from 'domelight.wasm?url';

const module = Module.load(fetch(moduleUrl));
let environment: Environment | undefined;
let pixels: Latlong | undefined;
/// The environment as a cube of the size of those that are drawn in the scene.
let behind: CubeLevel | undefined;

/// Larger textures are refused by many graphics cards.
const k_most_width = 8192;

function keep(name: string, format: string, made: Environment, latlong: Latlong, start: number): EnvironmentInfo {
    environment?.close();
    environment = made;
    behind = undefined;
    pixels = latlong;
    const shown = latlong.width > k_most_width ? reduce(latlong, k_most_width / 2) : latlong;
    return {name, format, width: shown.width, height: shown.height, texels: halfFloats(shown), warnings: made.warnings, milliseconds: performance.now() - start};
}
function open(name: string, bytes: ArrayBuffer, projection: string, loaded: Module, start: number): EnvironmentInfo {
    const made = loaded.open(name, bytes, projection);
    try {
        return keep(name, made.info.format, made, asLatlong(made), start);
    } catch (error) {
        if (made !== environment) made.close();
        throw error;
    }
}

function opened(): Environment {
    if (!environment) throw new Error('No environment has been opened.');
    return environment;
}

function source(): Latlong {
    if (!pixels) throw new Error('No environment has been opened.');
    return pixels;
}

function bake(from: Environment, size: number, smallest: number, irradianceSize: number): Bake {
    const start = performance.now();
    const sizes = sizesDownTo(size, smallest);
    const {chain, irradiance, sh} = from.prefilter('ggx', sizes, sizes.map((_, l) => levelRoughness(l, sizes.length)), irradianceSize);
    return {specular: chain, irradiance: irradiance!, sh: irradianceHarmonics(sh!), milliseconds: performance.now() - start};
}

/// Five levels of a cube that was drawn in the scene.
function live(size: number, texels: Float32Array, loaded: Module): Bake {
    if (behind?.size !== size) behind = opened().cube(size);
    const made = loaded.cubeEnvironment(size, overEnvironment(size, texels, behind));
    try {
        return bake(made, size, size / 16, 16);
    } finally {
        made.close();
    }
}

/// Coefficients of the irradiance E from those of the radiance: Ramamoorthi and Hanrahan 2001, eq. 7 to 9.
function irradianceHarmonics(radiance: Float64Array): Float32Array {
    const factors = [Math.PI, (2 * Math.PI) / 3, Math.PI / 4];
    return Float32Array.from(radiance, (v, k) => v * factors[Math.floor(Math.sqrt(Math.floor(k / 3)))]!);
}

async function answer(request: Request): Promise<Replies[Request['kind']]> {
    const start = performance.now();
    const loaded = await module;
    switch (request.kind) {
        case 'open':
            return open(request.name, request.bytes, request.projection, loaded, start);
        case 'use':
            return keep(request.name, 'computed in the page', loaded.environment(request.latlong), request.latlong, start);
        case 'bake':
            return bake(opened(), request.size, 16, 32);
        case 'live':
            return live(request.size, request.texels, loaded);
        case 'phong': {
            const sizes = sizesDownTo(request.size, 8);
            return opened().prefilter('phong', sizes, sizes.map((_, l) => levelExponent(l)), 0).chain;
        }
        case 'tables':
            return makeTables(source(), request.rows);
        case 'survey':
            return survey(source(), request.rows);
        case 'samples':
            return drawSamples(source(), request.count);
        case 'filtered':
            return opened().inDirections(request.lobe, request.parameter, request.directions);
        case 'picture':
            return readPicture(request.name, request.bytes);
    }
}

addEventListener('message', async ({data}: MessageEvent<{id: number; request: Request}>) => {
    try {
        const reply = await answer(data.request);
        postMessage({id: data.id, reply}, {transfer: buffersOf(reply)});
    } catch (error) {
        postMessage({id: data.id, error: (error as Error).message});
    }
});

/// All array buffers in a reply, which are handed over and not copied.
function buffersOf(value: unknown): ArrayBuffer[] {
    if (ArrayBuffer.isView(value)) return [value.buffer as ArrayBuffer];
    if (value === null || typeof value !== 'object') return [];
    return Object.values(value).flatMap(buffersOf);
}
