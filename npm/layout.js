// Structs of domelight_c.h as a 32-bit machine lays them out: numbers on multiples of their size.

const sizes = {pointer: 4, i32: 4, u32: 4, f32: 4, i64: 8, f64: 8};

/// A struct from its fields in order: [name, type] or [name, type, count].
class Struct {
    constructor(...fields) {
        let at = 0, largest = 4;
        this.fields = {};
        for (const [name, type, count = 1] of fields) {
            const size = sizes[type];
            at = Math.ceil(at / size) * size;
            this.fields[name] = {at, type, count};
            at += size * count;
            largest = Math.max(largest, size);
        }
        this.size = Math.ceil(at / largest) * largest;
    }

    write(view, address, values) {
        for (const [name, value] of Object.entries(values)) {
            if (value === undefined) continue;
            const {at, type, count} = this.fields[name];
            const list = count > 1 ? value : [value];
            for (let k = 0; k < count; ++k) writers[type](view, address + at + k * sizes[type], list[k]);
        }
    }

    read(view, address) {
        const values = {};
        for (const [name, {at, type, count}] of Object.entries(this.fields)) {
            const list = Array.from({length: count}, (_, k) => readers[type](view, address + at + k * sizes[type]));
            values[name] = count > 1 ? list : list[0];
        }
        return values;
    }
}

const writers = {
    pointer: (view, at, v) => view.setUint32(at, v, true),
    i32: (view, at, v) => view.setInt32(at, v, true),
    u32: (view, at, v) => view.setUint32(at, v, true),
    f32: (view, at, v) => view.setFloat32(at, v, true),
    i64: (view, at, v) => view.setBigInt64(at, BigInt(v), true),
    f64: (view, at, v) => view.setFloat64(at, v, true),
};
const readers = {
    pointer: (view, at) => view.getUint32(at, true),
    i32: (view, at) => view.getInt32(at, true),
    u32: (view, at) => view.getUint32(at, true),
    f32: (view, at) => view.getFloat32(at, true),
    i64: (view, at) => 2 ** 32 * view.getInt32(at + 4, true) + view.getUint32(at, true),
    f64: (view, at) => view.getFloat64(at, true),
};

const struct = (...fields) => new Struct(['structSize', 'pointer'], ...fields);

export const pixelsStruct = struct(['data', 'pointer'], ['width', 'i32'], ['height', 'i32'], ['faces', 'i32'], ['channels', 'i32'], ['bits', 'i32'],
                                   ['rowStride', 'i32']);
export const environmentOptionsStruct = struct(
    ['projection', 'pointer'], ['latlong', 'pointer'], ['layer', 'pointer'], ['faces', 'pointer'], ['faceOrientation', 'pointer'], ['decode', 'pointer'],
    ['negatives', 'pointer'], ['up', 'pointer'], ['rotateYDeg', 'f64'], ['exposure', 'f64'], ['maxBytes', 'i64'], ['threads', 'i32']);
export const environmentInfoStruct = struct(
    ['format', 'pointer'], ['projection', 'pointer'], ['convention', 'pointer'], ['width', 'i32'], ['height', 'i32'], ['latlongWidth', 'i32'],
    ['latlongHeight', 'i32'], ['worldToSource', 'f64', 9]);
export const levelStruct = struct(['lobe', 'pointer'], ['roughness', 'f64'], ['exponent', 'f64'], ['size', 'i32']);
export const prefilterOptionsStruct = struct(
    ['layout', 'pointer'], ['texels', 'pointer'], ['levels', 'pointer'], ['levelCount', 'pointer'], ['directions', 'pointer'], ['directionCount', 'pointer'],
    ['worldToSource', 'pointer'], ['irradianceSize', 'i32'], ['shBands', 'i32'], ['threads', 'i32'], ['progress', 'pointer'], ['progressData', 'pointer']);
export const samplerOptionsStruct = struct(['method', 'pointer'], ['weight', 'pointer'], ['uniformShare', 'f64'], ['compensate', 'i32'], ['threads', 'i32']);
export const lightsOptionsStruct = struct(
    ['leastShare', 'f64'], ['leastContrast', 'f64'], ['largestDiameterDeg', 'f64'], ['mergeDeg', 'f64'], ['maxLights', 'i32'], ['threads', 'i32']);
export const lightStruct = struct(
    ['direction', 'f64', 3], ['u', 'f64'], ['v', 'f64'], ['angularDiameterDeg', 'f64'], ['irradiance', 'f64', 3], ['meanRadiance', 'f64', 3],
    ['colour', 'f64', 3], ['share', 'f64'], ['contrast', 'f64'], ['texels', 'i64'], ['resolved', 'i32']);
export const encodeOptionsStruct = struct(['encoding', 'pointer'], ['quality', 'pointer'], ['threads', 'i32']);
export const textureInfoStruct = struct(['width', 'i32'], ['height', 'i32'], ['faces', 'i32'], ['levels', 'i32'], ['block', 'i32'], ['blockBytes', 'i32']);
export const encodingReportStruct = struct(['clippedTexels', 'i64'], ['clippedEnergy', 'f64'], ['rmsError', 'f64'], ['logPsnr', 'f64']);
export const bakeOptionsStruct = struct(
    ...['engines', 'layout', 'lobe', 'texels', 'encoding', 'encodingQuality', 'format', 'latlongOut', 'irradianceQuantity', 'shWindow', 'brdfMasking', 'roughness',
        'roughnessCount', 'exponents', 'exponentCount', 'progress', 'progressData'].map(name => [name, 'pointer']),
    ...['size', 'levels', 'irradianceSize', 'brdfSize', 'shBands', 'preview', 'hashes', 'threads'].map(name => [name, 'i32']));
/// domelight_light_samples: nine arrays.
export const sampleArrays = ['u', 'v', 'x', 'y', 'z', 'r', 'g', 'b', 'pdf'];
