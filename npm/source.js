// What engines give as a source of light, as the pixels that fromPixels() takes. Shared by the adapters.

import {DomelightError} from './errors.js';
import {Environment} from './index.js';
import {isPixels} from './pixels.js';

/// What use() gives of the environment that open() makes of a source, and closes it. A source that is an Environment itself is used and stays open.
export async function withEnvironment(source, open, use) {
    if (source instanceof Environment) return use(source);
    const environment = await open(source);
    try {
        return await use(environment);
    } finally {
        environment.close();
    }
}

/// Rows in reverse order.
export function flipped(data, rowLength) {
    const rows = data.length / rowLength, result = new data.constructor(data.length);
    for (let y = 0; y < rows; ++y) result.set(data.subarray(y * rowLength, (y + 1) * rowLength), (rows - 1 - y) * rowLength);
    return result;
}

/// Pixels of one to four channels as three or four: grey becomes RGB.
function colours(data, channels) {
    if (channels >= 3) return {data, channels};
    const result = new data.constructor((data.length / channels) * 3);
    for (let k = 0; k < data.length / channels; ++k) result.fill(data[channels * k], 3 * k, 3 * k + 3);
    return {data: result, channels: 3};
}

/// NaN, infinities and negative values become 0: loaders of engines do not repair them, as read() does.
export function repaired(data) {
    const half = !(data instanceof Float32Array), bad = half && data instanceof Uint16Array ? v => v & 0x8000 || v >= 0x7c00 : v => !(v >= 0 && v < Infinity);
    let result = data;
    for (let k = 0; k < data.length; ++k)
        if (bad(data[k])) {
            if (result === data) result = data.slice();
            result[k] = 0;
        }
    return result;
}

/// A lat-long map {data, width, height, channels}, or six faces: what fromPixels() takes. `topFirst`: the first row is the top.
export function latlongPixels({data, width, height}, topFirst) {
    if (!isPixels(data)) throw new DomelightError('The texture has no pixels of floats or half floats', '', 'Give the file itself: read() decodes it.');
    const found = colours(data, data.length / (width * height));
    if (!Number.isInteger(found.channels)) throw new DomelightError(`The texture has ${data.length} numbers for ${width} x ${height} pixels`);
    return {width, height, channels: found.channels, data: repaired(topFirst ? found.data : flipped(found.data, width * found.channels))};
}

/// Six arrays of a face each, one after the other: what fromPixels() takes.
export function cubePixels(faces, size) {
    const coloured = faces.map(face => colours(face, face.length / (size * size)).data);
    const {length} = coloured[0], data = new coloured[0].constructor(6 * length);
    coloured.forEach((face, f) => data.set(face, f * length));
    return {data: repaired(data), width: size, height: size, faces: 6, channels: length / size / size};
}
