// Pictures back from the graphics card.

import type * as THREE from 'three';
import type {Stage} from './stage';

/// The mean of a pane's frames: RGB floats, rows from the top.
export async function readPixels(stage: Stage, index: number): Promise<Float32Array> {
    const {target} = stage.panes[index]!, {width, height} = target, rgba = new Float32Array(4 * width * height);
    await stage.renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, rgba);
    const rgb = new Float32Array(3 * width * height);
    for (let y = 0, to = 0; y < height; ++y)
        for (let x = 0, from = 4 * (height - 1 - y) * width; x < width; ++x, from += 4, to += 3) {
            rgb[to] = rgba[from]!;
            rgb[to + 1] = rgba[from + 1]!;
            rgb[to + 2] = rgba[from + 2]!;
        }
    return rgb;
}

/// The same in base64, for tests.
export async function readPane(stage: Stage, index: number): Promise<string> {
    const bytes = new Uint8Array((await readPixels(stage, index)).buffer), parts = [];
    for (let k = 0; k < bytes.length; k += 0x8000) parts.push(String.fromCharCode(...bytes.subarray(k, k + 0x8000)));
    return btoa(parts.join(''));
}

/// The bytes of a target, RGBA, rows from the top. The target is given back.
export async function readBytes({renderer}: Stage, target: THREE.WebGLRenderTarget): Promise<Uint8Array<ArrayBuffer>> {
    const {width, height} = target, bottomFirst = new Uint8Array(4 * width * height), bytes = new Uint8Array(bottomFirst.length);
    await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, bottomFirst);
    for (let y = 0; y < height; ++y) bytes.set(bottomFirst.subarray(4 * (height - 1 - y) * width, 4 * (height - y) * width), 4 * y * width);
    target.dispose();
    return bytes;
}
