// Pictures of any shape, read in the worker: what a frame is compared with.

import {FloatType} from 'three';
import {readHdr} from './read_hdr';
import type {Latlong} from './types';

/// RGB floats, as they are stored. Throws an Error with a sentence.
export async function readPicture(name: string, bytes: ArrayBuffer): Promise<Latlong> {
    const start = new Uint8Array(bytes);
    try {
        if (start[0] === 0x23 && start[1] === 0x3f) return cleaned(readHdr(start));
        if (start[0] === 0x76 && start[1] === 0x2f && start[2] === 0x31) return await readExr(bytes);
    } catch (error) {
        throw new Error(`${name}: the file is damaged (${String((error as Error).message ?? error).replace(/^THREE\.\w+: /, '').replace(/\.$/, '')}).`);
    }
    throw new Error(`${name}: this is neither a Radiance .hdr nor an OpenEXR picture.`);
}

async function readExr(bytes: ArrayBuffer): Promise<Latlong> {
    checkExrHeader(new DataView(bytes));
    const {EXRLoader} = await import('three/addons/loaders/EXRLoader.js');
    const {width, height, data} = new EXRLoader().setDataType(FloatType).parse(bytes) as {width: number; height: number; data: Float32Array};
    const channels = data.length / (width * height), pixels = new Float32Array(3 * width * height);
    // The loader's first row is the bottom one.
    for (let y = 0, to = 0; y < height; ++y)
        for (let x = 0, from = (height - 1 - y) * width * channels; x < width; ++x, from += channels)
            for (let c = 0; c < 3; ++c) pixels[to++] = data[from + (channels >= 3 ? c : 0)]!;
    return cleaned({width, height, pixels});
}

/// Walks through the attributes: the loader reads on for ever in a header that does not end.
function checkExrHeader(view: DataView): void {
    let at = 8;
    const text = () => {
        const start = at;
        while (view.getUint8(at++) !== 0) if (at - start > 256) throw new Error('a name of the header is too long');
        return at - start - 1;
    };
    try {
        while (text() > 0) {
            text();
            at += 4 + view.getUint32(at, true);
        }
    } catch {
        throw new Error('its header does not end');
    }
}

/// Negative values, NaN and infinities become 0, because no light is like them.
function cleaned(latlong: Latlong): Latlong {
    const {pixels} = latlong;
    for (let k = 0; k < pixels.length; ++k) if (!(pixels[k]! >= 0 && pixels[k]! < Infinity)) pixels[k] = 0;
    return latlong;
}
