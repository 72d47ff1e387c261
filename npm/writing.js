// Files, in memory: whole bakes, textures in their containers, and pictures. Of domelight-bake.wasm.

import {DomelightError} from './errors.js';
import {bakeOptionsStruct, textureInfoStruct} from './layout.js';
import {check, checkEncoding, integer} from './options.js';
import {pixelsIn} from './pixels.js';

const words = ['layout', 'lobe', 'texels', 'encoding', 'encodingQuality', 'format', 'latlongOut', 'irradianceQuantity', 'shWindow', 'brdfMasking'];
const numbers = ['size', 'levels', 'irradianceSize', 'brdfSize', 'shBands'];
const lists = {roughness: 'roughnessCount', exponents: 'exponentCount'};
const switches = ['preview', 'hashes'];
const folder = 'out/';

/// What the module has written, as [{name, data}], in the order of the names. It keeps nothing of it.
function takeFiles(instance) {
    return instance.scope(scope => {
        const place = scope.bytes(12), count = instance.call('domelight_memory_file_count');
        const files = Array.from({length: count}, (_, k) => {
            instance.call('domelight_memory_file', k, place, place + 4, place + 8);
            const [name, at, size] = [0, 4, 8].map(offset => instance.view().getUint32(place + offset, true));
            return {name: instance.text(name), data: instance.bytes(at, size).slice()};
        });
        instance.call('domelight_memory_files_clear');
        return files;
    });
}

/// What is written while `work` runs. Nothing stays of what fails.
function filesOf(instance, work) {
    try {
        work();
        return takeFiles(instance);
    } catch (error) {
        if (!instance.broken) instance.call('domelight_memory_files_clear');
        throw error;
    }
}

/// The files of a bake. `environment` and `progress`: addresses.
export function bakeToFiles(instance, scope, environment, options, progress) {
    const given = check(options, 'engines', ...words, ...numbers, ...Object.keys(lists), ...switches);
    const {engines} = given, values = {progress};
    checkEncoding(given.encoding, true);
    if (engines !== undefined) values.engines = scope.word(Array.isArray(engines) ? engines.join(',') : engines, 'engines');
    for (const name of words) if (given[name] !== undefined) values[name] = scope.word(given[name], name);
    for (const name of numbers) values[name] = integer(given[name], name);
    for (const name of switches) if (given[name] !== undefined) values[name] = given[name] ? 1 : 0;
    for (const [name, count] of Object.entries(lists)) {
        if (given[name] === undefined) continue;
        const list = Float64Array.from(given[name]);
        Object.assign(values, {[name]: scope.copy(list), [count]: list.length});
    }
    const address = scope.options('bake_options', bakeOptionsStruct, values);
    const files = filesOf(instance, () => instance.run('domelight_bake', environment, address, scope.text(folder)));
    return files.map(({name, data}) => ({name: name.slice(folder.length), data}));
}

/// One level of pixels as .hdr or .exr: faces one below the other.
export function pictureFile(instance, levels, {format, ...others}) {
    for (const [name, value] of Object.entries(others))
        if (value !== undefined) throw new DomelightError(`is of textures, not of ${format}`, name);
    if (levels.length !== 1) throw new DomelightError(`${format} holds one picture, not ${levels.length} levels`, 'format', 'Write them one by one, or use ktx2.');
    const [{data, width, height, faces, channels}] = levels;
    if (data instanceof Uint8Array) throw new DomelightError(`${format} holds pixels of floats, not encoded texels`, 'format', 'prefilter() gives floats.');
    return instance.scope(scope => {
        const pixels = pixelsIn(scope, {data, width, height, faces, channels});
        return filesOf(instance, () => instance.run('domelight_pixels_write', pixels, scope.text(`picture.${format}`)))[0].data;
    });
}

/// A texture, by its address, in its container.
export function textureFile(instance, texture, {format, metadata = {}, supercompression, sh}) {
    return instance.scope(scope => {
        for (const [key, value] of Object.entries(metadata)) instance.run('domelight_texture_set_metadata', texture, scope.text(key), scope.text(value));
        if (sh) instance.run('domelight_texture_set_sh', texture, scope.copy(Float64Array.from(sh)), Math.round(Math.sqrt(sh.length / 3)));
        const bytes = scope.handle('domelight_texture_file', texture, scope.word(format, 'format'), scope.word(supercompression, 'supercompression'));
        try {
            const size = scope.bytes(4), at = instance.call('domelight_bytes_data', bytes, size);
            return instance.bytes(at, instance.view().getUint32(size, true)).slice();
        } finally {
            instance.call('domelight_bytes_free', bytes);
        }
    });
}

/// Encoded texels, as bake() and encode() give them, in their container.
export function texelsFile(instance, texture, file) {
    const {encoding, width, height, faces} = texture, turned = texture.mirrored && file.format === 'env' && faces === 6 && encoding === 'rgbd';
    const levels = turned ? texture.levels.map(unmirrored) : texture.levels, sh = turned && file.sh ? unmirroredHarmonics(file.sh) : file.sh;
    return instance.scope(scope => {
        const info = scope.struct(textureInfoStruct, {width, height, faces, levels: levels.length});
        const addresses = scope.bytes(4 * levels.length), sizes = scope.bytes(4 * levels.length);
        levels.forEach(({data}, l) => {
            const at = scope.copy(data);
            instance.view().setUint32(addresses + 4 * l, at, true);
            instance.view().setUint32(sizes + 4 * l, data.byteLength, true);
        });
        const made = scope.handle('domelight_texture_from_levels', info, scope.word(encoding, 'encoding'), addresses, sizes);
        try {
            return textureFile(instance, made, {...file, sh});
        } finally {
            instance.call('domelight_texture_free', made);
        }
    });
}

/// A level of a cube of four bytes a texel that is looked up by (-x, y, z), as one that is looked up by (x, y, z): the writer of .env mirrors it itself.
function unmirrored({data, width}) {
    const texels = new Uint32Array(data.slice().buffer), out = new Uint32Array(texels.length), face = width * width;
    for (let f = 0; f < 6; ++f)
        for (let y = 0; y < width; ++y)
            for (let x = 0; x < width; ++x) out[(f < 2 ? 1 - f : f) * face + y * width + x] = texels[f * face + y * width + width - 1 - x];
    return {data: new Uint8Array(out.buffer)};
}

/// Harmonics of the light with x the other way: (l, m) with m > 0 odd, or m < 0 even, change their sign.
function unmirroredHarmonics(sh) {
    return Float64Array.from(sh, (value, k) => {
        const l = Math.floor(Math.sqrt(Math.floor(k / 3))), m = Math.floor(k / 3) - l * l - l;
        return (m > 0 && m % 2 === 1) || (m < 0 && m % 2 === 0) ? -value : value;
    });
}
