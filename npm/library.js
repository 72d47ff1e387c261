// The library on this thread: each call blocks until it is done. index.js offers the same in a worker.

import {aborted, DomelightError} from './errors.js';
import {
    encodeOptionsStruct, encodingReportStruct, environmentInfoStruct, environmentOptionsStruct, levelStruct, lightsOptionsStruct, lightStruct, pixelsStruct,
    prefilterOptionsStruct, sampleArrays, samplerOptionsStruct, textureInfoStruct,
} from './layout.js';
import {compile, Instance} from './module.js';
import {check, checkEncoding, integer, integer64, number} from './options.js';
import {pixelsIn} from './pixels.js';
import {bakePlan, levelSpecs} from './plan.js';
import {bakeToFiles, pictureFile, texelsFile, textureFile} from './writing.js';

const environmentWords = ['projection', 'latlong', 'layer', 'faces', 'faceOrientation', 'decode', 'negatives', 'up'];

/// Starts an instance of the WebAssembly module on this thread. `module`: a WebAssembly.Module, its bytes, or a URL;
/// left out: the file beside this one.
export async function load({module = new URL('./domelight.wasm', import.meta.url)} = {}) {
    return new Library(await Instance.create(await compile(module)));
}

export class Library {
    #instance;

    constructor(instance) {
        this.#instance = instance;
    }

    get version() {
        return this.#instance.text(this.#instance.call('domelight_version'));
    }
    /// True after a fault or a lack of memory: nothing can be computed with this instance any more.
    get broken() {
        return !!this.#instance.broken;
    }
    /// Bytes of the instance's memory, which grows and never shrinks.
    get memoryBytes() {
        return this.#instance.exports.memory.buffer.byteLength;
    }

    /// Opens the bytes of one file: an ArrayBuffer or a view of one.
    read(bytes, options) {
        const {name = 'memory', rotateYDeg, exposure, maxBytes, ...words} = check(options, 'name', 'rotateYDeg', 'exposure', 'maxBytes', ...environmentWords);
        const array = bytesOf(bytes);
        if (!this.#instance.exports.domelight_environment_open_memory)
            throw new DomelightError('The WebAssembly module has no decoders of files', name === 'memory' ? '' : name, 'domelight-files.wasm has them: load() it as `module`.');
        return this.#instance.scope(scope => {
            const values = {rotateYDeg: number(rotateYDeg, 'rotateYDeg'), exposure: number(exposure, 'exposure'), maxBytes: integer64(maxBytes, 'maxBytes')};
            for (const field of environmentWords) if (words[field] !== undefined) values[field] = scope.word(words[field], field);
            const given = scope.options('environment_options', environmentOptionsStruct, values);
            return this.#environment(scope.handle('domelight_environment_open_memory', scope.copy(array), array.byteLength, scope.text(name), given));
        });
    }

    /// Makes an environment of pixels: {data, width, height, faces = 1 or 6, channels = 3 or 4}.
    fromPixels(pixels, options) {
        const {worldToSource} = check(options, 'worldToSource');
        return this.#instance.scope(scope => {
            const turn = worldToSource ? scope.copy(matrix(worldToSource)) : 0;
            return this.#environment(scope.handle('domelight_environment_from_pixels', pixelsIn(scope, pixels), turn));
        });
    }

    #environment(handle) {
        return new LibraryEnvironment(this, this.#instance, handle);
    }

    /// Everything that is filtered, in one reading of the environment.
    prefilter(environment, options) {
        const {progress, signal, ...asked} = check(
            options, 'levels', 'size', 'lobe', 'roughness', 'layout', 'texels', 'directions', 'worldToSource', 'irradianceSize', 'shBands', 'progress', 'signal');
        const levels = levelSpecs(asked);
        return this.#filtered(environment, {...asked, levels}, progress, signal, handle => {
            const result = this.#results(handle, asked);
            result.levels = levels.map((level, l) => ({...level, ...this.#instance.scope(scope => scope.pixels('domelight_filtered_level', handle, l))}));
            return result;
        });
    }

    /// What an engine loads: the levels of a plan, encoded.
    bake(environment, options) {
        const {progress, signal, quality, ...asked} = check(
            options, 'engine', 'size', 'levels', 'lobe', 'roughness', 'layout', 'texels', 'mirror', 'encoding', 'quality', 'irradianceSize', 'shBands', 'progress',
            'signal');
        const plan = bakePlan(asked);
        return this.#filtered(environment, plan, progress, signal, handle => this.#baked(handle, plan, quality));
    }

    /// Irradiance, harmonics and the mean of a filtered environment.
    #results(handle, {irradianceSize, shBands}) {
        const instance = this.#instance, result = {};
        if (irradianceSize) result.irradianceOverPi = instance.scope(scope => scope.pixels('domelight_filtered_irradiance_over_pi', handle));
        instance.scope(scope => {
            const count = scope.bytes(4), sh = instance.call('domelight_filtered_sh', handle, count);
            if (shBands) result.sh = new Float64Array(instance.exports.memory.buffer, sh, 3 * instance.view().getUint32(count, true)).slice();
            const mean = scope.bytes(24);
            instance.call('domelight_filtered_mean', handle, mean);
            result.mean = [0, 8, 16].map(at => instance.view().getFloat64(mean + at, true));
        });
        return result;
    }

    #filtered(environment, options, progress, signal, use) {
        return this.#watched(progress, signal, (scope, address) => scope.handle(
            'domelight_prefilter', handleOf(environment, LibraryEnvironment), this.#filterOptions(scope, options, address)), handle => this.#useFiltered(handle, use));
    }

    /// What `work` returns, which is given the address of the progress callback, and what `use` makes of that.
    #watched(progress, signal, work, use = result => result) {
        return this.#instance.scope(scope => {
            const told = this.#progress(progress, signal);
            let result;
            try {
                result = work(scope, told?.address);
            } catch (error) {
                if (told?.thrown) throw told.thrown;
                throw error.cancelled ? aborted(signal) : error;
            }
            return use(result);
        });
    }

    #filterOptions(scope, {layout, texels, levels, directions, worldToSource, irradianceSize, shBands}, progress) {
        const aims = directions === undefined ? undefined : triples(directions, 'directions');
        const instance = this.#instance, specs = scope.bytes(levelStruct.size * Math.max(levels.length, 1));
        levels.forEach(({size, roughness, exponent, lobe}, l) => {
            const at = specs + l * levelStruct.size;
            instance.call('domelight_level_init_sized', at, levelStruct.size);
            const word = lobe === undefined ? undefined : scope.word(lobe, 'lobe');
            levelStruct.write(instance.view(), at, {size: integer(size, 'size'), roughness: number(roughness, 'roughness'), exponent: number(exponent, 'exponent'), lobe: word});
        });
        return scope.options('prefilter_options', prefilterOptionsStruct, {
            layout: scope.word(layout, 'layout'), texels: scope.word(texels, 'texels'), levels: specs, levelCount: levels.length,
            directions: aims && scope.copy(aims), directionCount: aims && aims.length / 3, worldToSource: worldToSource ? scope.copy(matrix(worldToSource)) : 0,
            irradianceSize: integer(irradianceSize, 'irradianceSize'), shBands: integer(shBands, 'shBands'), progress,
        });
    }

    #useFiltered(handle, use) {
        try {
            return use(handle);
        } finally {
            if (!this.#instance.broken) this.#instance.call('domelight_filtered_free', handle);
        }
    }

    /// What bakes many cubes of one size, as bake() does one environment: what depends on the size alone is computed here, once.
    probeFilter(options) {
        const {quality, cubeSize, ...asked} = check(
            options, 'engine', 'size', 'cubeSize', 'levels', 'lobe', 'roughness', 'layout', 'texels', 'mirror', 'encoding', 'quality', 'irradianceSize', 'shBands');
        const plan = bakePlan({size: cubeSize, ...asked}), instance = this.#instance;
        const handle = instance.scope(scope => scope.handle('domelight_probe_filter_make', integer(cubeSize ?? plan.levels[0].size, 'cubeSize'), this.#filterOptions(scope, plan)));
        return new LibraryProbeFilter(instance, handle, pixels => instance.scope(scope => this.#useFiltered(
            scope.handle('domelight_probe_filter_filter', handle, pixelsIn(scope, pixels)), filtered => this.#baked(filtered, plan, quality))));
    }

    #baked(handle, plan, quality) {
        return {engine: plan.engine, mirrored: !!plan.worldToSource, ...this.#encoded({handle}, {encoding: plan.encoding, quality}), ...this.#results(handle, plan), specs: plan.levels};
    }

    /// The progress callback as the library calls it. What it throws stops the work, and is thrown again after that.
    #progress(progress, signal) {
        if (progress !== undefined && typeof progress !== 'function') throw new DomelightError('is not a function', 'progress');
        if (signal?.aborted) throw aborted(signal);
        if (!progress && !signal) return undefined;
        const told = {};
        told.address = this.#instance.functionAddress((_, stage, done) => {
            try {
                progress?.(done, this.#instance.text(stage));
            } catch (error) {
                told.thrown = error;
                return 1;
            }
            return signal?.aborted ? 1 : 0;
        });
        return told;
    }

    /// Irradiance of the hemisphere around each direction, divided by π.
    irradiance(environment, options) {
        const {size = 32, layout} = check(options, 'size', 'layout');
        return this.#instance.scope(scope => this.#image(scope.handle(
            'domelight_irradiance', handleOf(environment, LibraryEnvironment), scope.word(layout, 'layout'), integer(size, 'size'), 0)));
    }

    #image(image) {
        try {
            return this.#instance.scope(scope => scope.pixels('domelight_image_pixels', image));
        } finally {
            this.#instance.call('domelight_image_free', image);
        }
    }

    sphericalHarmonics(environment, options) {
        const {bands = 3, quantity, window} = check(options, 'bands', 'quantity', 'window');
        if (!(Number.isInteger(bands) && bands >= 1 && bands <= 64)) throw new DomelightError(`${bands} is not from 1 to 64`, 'bands');
        return this.#instance.scope(scope => {
            const rgb = scope.bytes(24 * bands * bands);
            this.#instance.run('domelight_spherical_harmonics', handleOf(environment, LibraryEnvironment), bands, scope.word(quantity, 'quantity'),
                               scope.word(window, 'window'), 0, rgb);
            return new Float64Array(this.#instance.exports.memory.buffer, rgb, 3 * bands * bands).slice();
        });
    }

    brdfTable(options) {
        const {size = 128, masking} = check(options, 'size', 'masking');
        return this.#instance.scope(scope => this.#image(scope.handle('domelight_brdf_table', integer(size, 'size'), scope.word(masking, 'masking'), 0)));
    }

    lights(environment, options) {
        const names = Object.keys(lightsOptionsStruct.fields).filter(name => name !== 'structSize' && name !== 'threads');
        const values = {...check(options, ...names)};
        for (const name of names) number(values[name], name);
        const instance = this.#instance;
        return instance.scope(scope => {
            const lights = scope.handle('domelight_extract_lights', handleOf(environment, LibraryEnvironment),
                                        scope.options('lights_options', lightsOptionsStruct, values));
            try {
                return Array.from({length: instance.call('domelight_lights_count', lights)}, (_, k) => {
                    const light = scope.struct(lightStruct, {});
                    instance.run('domelight_lights_get', lights, k, light);
                    const {structSize, resolved, ...values} = lightStruct.read(instance.view(), light);
                    return {...values, resolved: !!resolved};
                });
            } finally {
                instance.call('domelight_lights_free', lights);
            }
        });
    }

    /// Encodes levels as texels that a graphics processor reads.
    encode(levels, options) {
        const {encoding, quality} = check(options, 'encoding', 'quality');
        const list = Array.isArray(levels) ? levels : [levels];
        return this.#encoded({list}, {encoding, quality});
    }

    #encoded(levels, options) {
        return this.#withTexture(levels, options, (scope, texture) => this.#texture(scope, texture, options.encoding ?? 'rgba16f'));
    }

    /// What `use` makes of a texture: a filtered environment, or a list of pixels, encoded.
    #withTexture({handle, list}, {encoding, quality}, use) {
        const instance = this.#instance;
        checkEncoding(encoding, this.#writesFiles);
        return instance.scope(scope => {
            const options = scope.options('encode_options', encodeOptionsStruct, {encoding: scope.word(encoding, 'encoding'), quality: scope.word(quality, 'quality')});
            let texture;
            if (handle) {
                texture = scope.handle('domelight_encode_filtered', handle, options);
            } else {
                const all = scope.bytes(pixelsStruct.size * Math.max(list.length, 1));
                list.forEach((level, l) => {
                    const one = pixelsIn(scope, level);
                    instance.bytes(all + l * pixelsStruct.size, pixelsStruct.size).set(instance.bytes(one, pixelsStruct.size));
                });
                texture = scope.handle('domelight_encode', all, list.length, options);
            }
            try {
                return use(scope, texture);
            } finally {
                instance.call('domelight_texture_free', texture);
            }
        });
    }

    get #writesFiles() {
        return !!this.#instance.exports.domelight_texture_file;
    }
    #checkWriting() {
        if (!this.#writesFiles) throw new DomelightError('The WebAssembly module writes no files', '', 'domelight-bake.wasm does: load() it as `module`.');
    }

    /// Everything that `domelight bake` writes for engines, as [{name, data}].
    bakeFiles(environment, options) {
        this.#checkWriting();
        const {progress, signal, ...given} = options ?? {};
        return this.#watched(progress, signal, (scope, address) => bakeToFiles(this.#instance, scope, handleOf(environment, LibraryEnvironment), given, address));
    }

    /// The bytes of one file: of encoded texels as bake() and encode() give them, of pixels, or of an environment as a lat-long map.
    write(what, options) {
        this.#checkWriting();
        const {format = 'ktx2', encoding, quality, metadata, supercompression} = check(options, 'format', 'encoding', 'quality', 'metadata', 'supercompression');
        if (typeof what !== 'object' || what === null)
            throw new DomelightError('The first argument is neither pixels nor a texture', '', 'bake(), encode() and prefilter() make what can be written.');
        if (what instanceof LibraryEnvironment) return this.write(what.latlong(), options);
        if (metadata !== undefined && (typeof metadata !== 'object' || metadata === null)) throw new DomelightError('is not an object of texts', 'metadata');
        const instance = this.#instance, levels = Array.isArray(what) ? what : what.levels ?? [what];
        if (format === 'exr' || format === 'hdr') return pictureFile(instance, levels, {format, encoding, quality, metadata, supercompression});
        const file = {format, metadata, supercompression, sh: what.sh};
        if (levels[0]?.data instanceof Uint8Array) {
            if (encoding !== undefined && encoding !== what.encoding) throw new DomelightError(`is ${encoding}, but the texels are ${what.encoding}`, 'encoding', 'Leave it out.');
            return texelsFile(instance, what, file);
        }
        return this.#withTexture({list: levels.map(({data, width, height, faces, channels}) => ({data, width, height, faces, channels}))},
                                 {encoding: encoding ?? (format === 'env' ? 'rgbd' : undefined), quality}, (_, texture) => textureFile(instance, texture, file));
    }

    #texture(scope, texture, encoding) {
        const instance = this.#instance, info = scope.struct(textureInfoStruct, {});
        instance.run('domelight_texture_get_info', texture, info);
        const {structSize, levels, ...facts} = textureInfoStruct.read(instance.view(), info);
        const out = scope.bytes(8);
        return {
            encoding, ...facts,
            levels: Array.from({length: levels}, (_, l) => {
                instance.run('domelight_texture_level', texture, l, out, out + 4);
                const address = instance.view().getUint32(out, true), size = instance.view().getUint32(out + 4, true);
                const data = instance.bytes(address, size).slice();
                const report = scope.struct(encodingReportStruct, {});
                instance.run('domelight_texture_report', texture, l, report);
                const {clippedTexels, clippedEnergy, rmsError} = encodingReportStruct.read(instance.view(), report);
                return {data, width: Math.max(1, facts.width >> l), height: Math.max(1, facts.height >> l), clippedTexels, clippedEnergy, rmsError};
            }),
        };
    }

    /// Draws light directions in proportion to the radiance.
    sampler(environment, options) {
        const {method, weight, uniformShare, compensate} = check(options, 'method', 'weight', 'uniformShare', 'compensate');
        return this.#instance.scope(scope => {
            const given = scope.options('sampler_options', samplerOptionsStruct, {
                ...(method !== undefined && {method: scope.word(method, 'method')}), ...(weight !== undefined && {weight: scope.word(weight, 'weight')}),
                uniformShare: number(uniformShare, 'uniformShare'), ...(compensate !== undefined && {compensate: compensate ? 1 : 0}),
            });
            return new LibrarySampler(this.#instance, scope.handle('domelight_sampler_build', handleOf(environment, LibraryEnvironment), given));
        });
    }
}

/// Memory of the module that a handle stands for; `close` frees it. What is forgotten is freed some time after the handle is.
class Handle {
    static #forgotten = new FinalizationRegistry(({instance, name, address}) => {
        if (!instance.broken) instance.call(name, address);
    });
    #address;
    #free;
    constructor(instance, address, free) {
        this.instance = instance;
        this.#address = address;
        this.#free = free;
        Handle.#forgotten.register(this, {instance, name: free, address}, this);
    }
    get address() {
        if (!this.#address) throw new DomelightError('This object has been closed');
        return this.#address;
    }
    close() {
        if (!this.#address) return;
        Handle.#forgotten.unregister(this);
        if (!this.instance.broken) this.instance.call(this.#free, this.#address);
        this.#address = 0;
    }
    [Symbol.dispose ?? Symbol('dispose')]() {
        this.close();
    }
}

function handleOf(value, kind) {
    if (!(value instanceof kind)) throw new DomelightError('The first argument is not an environment of this library', '', 'read() and fromPixels() make one.');
    return value.address;
}

export class LibraryEnvironment extends Handle {
    constructor(library, instance, address) {
        super(instance, address, 'domelight_environment_free');
        this.library = library;
        const {structSize, ...info} = instance.scope(scope => {
            const at = scope.struct(environmentInfoStruct, {});
            instance.run('domelight_environment_get_info', address, at);
            return environmentInfoStruct.read(instance.view(), at);
        });
        for (const name of ['format', 'projection', 'convention']) info[name] = instance.text(info[name]);
        this.info = info;
    }
    /// Warnings about the file, and a line on what was repaired, once it has been read.
    get warnings() {
        const count = this.instance.call('domelight_environment_warning_count', this.address);
        return Array.from({length: count}, (_, k) => this.instance.text(this.instance.call('domelight_environment_warning', this.address, k)));
    }
    radiance(direction) {
        if (direction?.length !== 3) throw new DomelightError('is not three numbers', 'direction');
        return this.instance.scope(scope => {
            const rgb = scope.bytes(12);
            this.instance.run('domelight_environment_radiance', this.address, scope.copy(Float64Array.from(direction)), rgb);
            return [0, 4, 8].map(at => this.instance.view().getFloat32(rgb + at, true));
        });
    }
    latlong() {
        return this.instance.scope(scope => {
            const image = scope.handle('domelight_environment_latlong', this.address);
            try {
                return scope.pixels('domelight_image_pixels', image);
            } finally {
                this.instance.call('domelight_image_free', image);
            }
        });
    }
}

export class LibraryProbeFilter extends Handle {
    #bake;
    constructor(instance, address, bake) {
        super(instance, address, 'domelight_probe_filter_free');
        this.#bake = bake;
    }
    /// The levels of a cube's pixels: {data, width, height, faces: 6, channels}.
    bake(pixels) {
        return this.address && this.#bake(pixels);
    }
}

export class LibrarySampler extends Handle {
    constructor(instance, address) {
        super(instance, address, 'domelight_sampler_free');
    }
    /// Directions for points of the unit square: a Uint32Array of pairs of x 2^32 and y 2^32, or {count, sequence, seed, first, total}.
    sample(points) {
        return this.instance.scope(scope => {
            const {address, count} = points instanceof Uint32Array ? {address: scope.copy(points), count: points.length / 2} : this.#sequence(scope, points);
            if (!Number.isInteger(count)) throw new DomelightError('are not pairs', 'points');
            return this.#many(scope, count, ['u', 'v', 'x', 'y', 'z', 'r', 'g', 'b', 'pdf'], {}, arrays =>
                this.instance.run('domelight_sampler_sample_many', this.address, address, count, arrays));
        });
    }
    #sequence(scope, given) {
        const {count, sequence, seed = 0, first = 0, total} = check(given, 'count', 'sequence', 'seed', 'first', 'total');
        if (!(Number.isInteger(count) && count >= 1 && count < 2 ** 28)) throw new DomelightError(`${count} is not a number of points`, 'count');
        const address = scope.bytes(8 * count);
        this.instance.run('domelight_sequence_points', scope.word(sequence, 'sequence'), BigInt(seed), integer(first, 'first'), count,
                          integer(total ?? first + count, 'total'), address);
        return {address, count};
    }
    /// Radiance and density in directions: a Float32Array of three numbers each.
    lookUp(directions) {
        if (!(directions instanceof Float32Array) || directions.length % 3) throw new DomelightError('is not a Float32Array of three numbers each', 'directions');
        const count = directions.length / 3, axis = c => Float32Array.from({length: count}, (_, k) => directions[3 * k + c]);
        return this.instance.scope(scope => this.#many(scope, count, ['u', 'v', 'r', 'g', 'b', 'pdf'], {x: axis(0), y: axis(1), z: axis(2)}, arrays =>
            this.instance.run('domelight_sampler_look_up_many', this.address, count, arrays)));
    }
    #many(scope, count, names, inputs, run) {
        const at = Object.fromEntries(names.map(name => [name, scope.bytes(4 * count)]));
        for (const [name, values] of Object.entries(inputs)) at[name] = scope.copy(values);
        const arrays = scope.bytes(4 * sampleArrays.length);
        sampleArrays.forEach((name, k) => this.instance.view().setUint32(arrays + 4 * k, at[name] ?? 0, true));
        run(arrays);
        return Object.fromEntries(names.map(name => [name, new Float32Array(this.instance.exports.memory.buffer, at[name], count).slice()]));
    }
}

/// The bytes of a file, as a view.
export function bytesOf(bytes) {
    const buffer = bytes instanceof ArrayBuffer ? bytes : ArrayBuffer.isView(bytes) ? bytes.buffer : undefined;
    if (!buffer) throw new DomelightError('The file is neither an ArrayBuffer nor a view of one');
    if (isDetached(buffer)) throw new DomelightError('The buffer of the file has been transferred to another thread, and is empty');
    return bytes === buffer ? new Uint8Array(buffer) : new Uint8Array(buffer, bytes.byteOffset, bytes.byteLength);
}

const isDetached = buffer => {
    if (buffer.byteLength > 0) return false;
    try {
        new Uint8Array(buffer);
        return false;
    } catch {
        return true;
    }
};

/// Directions of three numbers each.
function triples(values, field) {
    if (!(values?.length > 0) || values.length % 3) throw new DomelightError('is not an array of three numbers each', field);
    return Float64Array.from(values);
}

function matrix(values) {
    if (values?.length !== 9) throw new DomelightError('is not nine numbers, a 3 x 3 matrix by rows', 'worldToSource');
    return Float64Array.from(values);
}
