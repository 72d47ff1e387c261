// Pixels of JavaScript, checked, in the memory of the module; and how the cubes of engines lie.

import {DomelightError} from './errors.js';
import {pixelsStruct} from './layout.js';
import {check} from './options.js';

/// Whether it is an array of floats or half floats.
export const isPixels = data => data instanceof Float32Array || data instanceof Uint16Array || (typeof Float16Array === 'function' && data instanceof Float16Array);

/// The shape of pixels, which must fit the array.
export function checkPixels(pixels) {
    const {data, width, height, faces = 1, channels = 3} = check(pixels, 'data', 'width', 'height', 'faces', 'channels', 'roughness', 'exponent', 'lobe', 'size');
    if (!isPixels(data)) throw new DomelightError('is neither a Float32Array nor a Uint16Array of half floats', 'data');
    for (const [name, value] of Object.entries({width, height, faces, channels}))
        if (!(Number.isInteger(value) && value >= 1)) throw new DomelightError(`${value} is not a whole number above 0`, name);
    const expected = width * height * faces * channels;
    if (data.length !== expected)
        throw new DomelightError(`has ${data.length} numbers, not ${expected}: width ${width}, height ${height}, faces ${faces}, channels ${channels}`, 'data',
                                 data.length === 0 ? 'Its buffer may have been transferred to another thread.' : '');
    return {data, width, height, faces, channels};
}

/// worldToSource of cubes that an engine looks up by (-x, y, z) for the light from direction (x, y, z).
export const mirroredX = [-1, 0, 0, 0, 1, 0, 0, 0, 1];

/// The address of a domelight_pixels that describes a copy of them.
export function pixelsIn(scope, pixels) {
    const {data, width, height, faces, channels} = checkPixels(pixels);
    return scope.struct(pixelsStruct, {data: scope.copy(data), width, height, faces, channels, bits: 8 * data.BYTES_PER_ELEMENT});
}
