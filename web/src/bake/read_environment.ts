// Files of environments, read in the worker.

import {FloatType} from 'three';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
import {HDRLoader} from 'three/addons/loaders/HDRLoader.js';
import type {Latlong} from './types';

interface Decoded {
    width: number;
    height: number;
    data: Float32Array;
}

/// The pixels of a lat-long file, as they are stored. Throws an Error with a sentence.
export function readLatlong(name: string, bytes: ArrayBuffer): {format: string; latlong: Latlong} {
    const start = new Uint8Array(bytes, 0, Math.min(4, bytes.byteLength));
    if (start[0] === 0x23 && start[1] === 0x3f) return {format: 'Radiance HDR', latlong: readHdr(name, bytes)};
    if (start[0] === 0x76 && start[1] === 0x2f && start[2] === 0x31) return {format: 'OpenEXR', latlong: readExr(name, bytes)};
    throw new Error(`${name}: this is not a Radiance HDR or OpenEXR file.`);
}

function readHdr(name: string, bytes: ArrayBuffer): Latlong {
    const {width, height, data} = told(name, () => new HDRLoader().setDataType(FloatType).parse(bytes) as Decoded);
    return rgbOf(name, width, height, data, false);
}

function readExr(name: string, bytes: ArrayBuffer): Latlong {
    const {width, height, data} = told(name, () => new EXRLoader().setDataType(FloatType).parse(bytes) as Decoded);
    return rgbOf(name, width, height, data, true);
}

function told<T>(name: string, read: () => T): T {
    try {
        return read();
    } catch (error) {
        throw new Error(`${name}: the file is damaged (${String((error as Error).message ?? error).replace(/^THREE\.\w+: /, '')}).`);
    }
}

/// RGB rows from the top. Negative values, NaN and infinities become 0, because no light is like them.
function rgbOf(name: string, width: number, height: number, rgba: Float32Array, bottomFirst: boolean): Latlong {
    if (width !== 2 * height)
        throw new Error(`${name}: the image is ${width} x ${height}, but a lat-long map must be twice as wide as high.`);
    const channels = rgba.length / (width * height);
    const pixels = new Float32Array(3 * width * height);
    for (let y = 0, to = 0; y < height; ++y) {
        let from = (bottomFirst ? height - 1 - y : y) * width * channels;
        for (let x = 0; x < width; ++x, from += channels)
            for (let c = 0; c < 3; ++c) {
                const v = rgba[from + (channels >= 3 ? c : 0)]!;
                pixels[to++] = v > 0 && v < Infinity ? v : 0;
            }
    }
    return {width, height, pixels};
}
