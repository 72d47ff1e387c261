// The comparison of two pictures, beside the page.

import {flip} from './flip';
import {heat} from './heat';

export interface Pictures {
    width: number;
    height: number;
    /// RGBA bytes of sRGB, rows from the top.
    test: Uint8Array<ArrayBuffer>;
    reference: Uint8Array<ArrayBuffer>;
    /// The number of the object in each pixel, 0 for the background.
    objects: Uint16Array<ArrayBuffer>;
}
export interface ObjectError {
    object: number;
    pixels: number;
    /// Root mean square of the difference of the displayed values, of 255.
    rmse: number;
    flip: number;
}
export interface Comparison {
    all: ObjectError;
    objects: ObjectError[];
    /// RGBA bytes: FLIP in colours.
    map: Uint8Array;
}

function compare({width, height, test, reference, objects}: Pictures): Comparison {
    const n = width * height, flips = flip(test, reference, width, height), squares = new Float32Array(n);
    for (let k = 0; k < n; ++k) for (let c = 0; c < 3; ++c) squares[k]! += (test[4 * k + c]! - reference[4 * k + c]!) ** 2 / 3;
    const errors = new Map<number, ObjectError>();
    const add = (object: number, k: number) => {
        let error = errors.get(object);
        if (!error) errors.set(object, (error = {object, pixels: 0, rmse: 0, flip: 0}));
        ++error.pixels;
        error.rmse += squares[k]!;
        error.flip += flips[k]!;
    };
    for (let k = 0; k < n; ++k) {
        add(-1, k);
        if (objects[k]! > 0) add(objects[k]!, k);
    }
    for (const error of errors.values()) {
        error.rmse = Math.sqrt(error.rmse / error.pixels);
        error.flip /= error.pixels;
    }
    const all = errors.get(-1)!;
    errors.delete(-1);
    return {all, objects: [...errors.values()].sort((a, b) => b.flip - a.flip), map: heat(flips)};
}

addEventListener('message', ({data}: MessageEvent<Pictures>) => {
    const result = compare(data);
    postMessage(result, {transfer: [result.map.buffer as ArrayBuffer]});
});
