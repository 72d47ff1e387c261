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
    const read = readPicture(name, bytes), {width, height} = read.latlong;
    if (width !== 2 * height)
        throw new Error(`${name}: the image is ${width} x ${height}, but a lat-long map must be twice as wide as high.`);
    return read;
}

/// The pixels of a picture of any shape.
export function readPicture(name: string, bytes: ArrayBuffer): {format: string; latlong: Latlong} {
    const start = new Uint8Array(bytes, 0, Math.min(4, bytes.byteLength));
    if (start[0] === 0x23 && start[1] === 0x3f) {
        const decoded = told(name, () => new HDRLoader().setDataType(FloatType).parse(bytes) as Decoded);
        return {format: 'Radiance HDR', latlong: rgbOf(decoded, false)};
    }
    if (start[0] === 0x76 && start[1] === 0x2f && start[2] === 0x31) {
        const decoded = told(name, () => new EXRLoader().setDataType(FloatType).parse(bytes) as Decoded);
        return {format: 'OpenEXR', latlong: rgbOf(decoded, true)};
    }
    throw new Error(`${name}: this is not a Radiance HDR or OpenEXR file.`);
}

function told<T>(name: string, read: () => T): T {
    try {
        return read();
    } catch (error) {
        throw new Error(`${name}: the file is damaged (${String((error as Error).message ?? error).replace(/^THREE\.\w+: /, '')}).`);
    }
}

/// RGB rows from the top. Negative values, NaN and infinities become 0, because no light is like them.
function rgbOf({width, height, data: rgba}: Decoded, bottomFirst: boolean): Latlong {
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
