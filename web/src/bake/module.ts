// The WebAssembly module by its C interface (include/domelight/domelight_c.h): the few calls that the app makes. Structs are written
// as a 32-bit machine lays them out.

import type {Chain, CubeLevel, Latlong, Lobe} from './types';

type Call = (...args: number[]) => number;

interface Exports {
    memory: WebAssembly.Memory;
    malloc: Call;
    free: Call;
    _initialize?: () => void;
    [name: string]: unknown;
}

/// A refusal of the library: what is wrong, where, and what to do about it.
export class ModuleError extends Error {}

const k_pixels_bytes = 32;
const k_level_bytes = 32;
const k_options_bytes = 64;
const k_info_bytes = 104;
const k_environment_options_bytes = 72;

export class Module {
    private constructor(private readonly exports: Exports) {}

    static async load(source: Response | Promise<Response>): Promise<Module> {
        // The module has no files: 8 is WASI's "bad descriptor".
        const imports = {
            wasi_snapshot_preview1: new Proxy({}, {get: (_, name) => (name === 'proc_exit' ? exit : () => 8)}),
        };
        const {instance} = await WebAssembly.instantiateStreaming(source, imports);
        const exports = instance.exports as unknown as Exports;
        exports._initialize?.();
        return new Module(exports);
    }

    /// An environment of pixels, which are copied. `close` it.
    environment(latlong: Latlong): Environment {
        return this.withPixels(latlong, (pixels, scope) => {
            const handle = scope.bytes(4);
            this.check(this.call('domelight_environment_from_pixels', pixels, 0, handle));
            return new Environment(this, this.words(handle)[0]!);
        });
    }
    /// An environment of a cube: RGB of its faces one after the other. `close` it.
    cubeEnvironment(size: number, pixels: Float32Array): Environment {
        return this.withPixels({width: size, height: size, pixels}, (struct, scope) => {
            this.words(struct)[4] = 6;
            const handle = scope.bytes(4);
            this.check(this.call('domelight_environment_from_pixels', struct, 0, handle));
            return new Environment(this, this.words(handle)[0]!);
        });
    }
    /// The environment of a file of any format and projection that the library reads. projection: empty where the file says it. `close` it.
    open(name: string, bytes: ArrayBuffer, projection: string): Environment {
        return this.scope(scope => {
            const data = scope.bytes(bytes.byteLength), handle = scope.bytes(4), options = scope.bytes(k_environment_options_bytes);
            new Uint8Array(this.exports.memory.buffer, data, bytes.byteLength).set(new Uint8Array(bytes));
            const called = scope.string(name), word = scope.string(projection || 'auto');
            this.call('domelight_environment_options_init_sized', options, k_environment_options_bytes);
            this.words(options)[1] = word;
            this.check(this.call('domelight_environment_open_memory', data, bytes.byteLength, called, options, handle));
            return new Environment(this, this.words(handle)[0]!);
        });
    }
    private withPixels<T>(latlong: Latlong, work: (pixels: number, scope: Scope) => T): T {
        return this.scope(scope => {
            const pixels = scope.bytes(k_pixels_bytes);
            this.call('domelight_pixels_init_sized', pixels, k_pixels_bytes);
            const data = scope.bytes(latlong.pixels.byteLength);
            this.floats(data, latlong.pixels.length).set(latlong.pixels);
            this.words(pixels).set([data, latlong.width, latlong.height], 1);
            return work(pixels, scope);
        });
    }

    /// The levels of a texture of half floats.
    levels(texture: number): CubeLevel[] {
        return this.scope(scope => {
            const info = scope.bytes(28), pointer = scope.bytes(4), size = scope.bytes(4);
            this.words(info)[0] = 28;
            this.check(this.call('domelight_texture_get_info', texture, info));
            const [, width, , , count] = this.words(info);
            return Array.from({length: count!}, (_, level) => {
                this.check(this.call('domelight_texture_level', texture, level, pointer, size));
                const start = this.words(pointer)[0]!;
                return {
                    size: Math.max(1, width! >> level),
                    texels: new Uint16Array(this.exports.memory.buffer.slice(start, start + this.words(size)[0]!)),
                };
            });
        });
    }

    /// Encodes pixels that the library returned, as half floats.
    encode(pixels: number): CubeLevel {
        return this.scope(scope => {
            const texture = scope.bytes(4);
            this.check(this.call('domelight_encode', pixels, 1, 0, texture));
            const levels = this.levels(this.words(texture)[0]!);
            this.call('domelight_texture_free', this.words(texture)[0]!);
            return levels[0]!;
        });
    }

    call(name: string, ...args: number[]): number {
        return (this.exports[name] as Call)(...args);
    }
    words(pointer: number): Uint32Array {
        return new Uint32Array(this.exports.memory.buffer, pointer, 16);
    }
    floats(pointer: number, count: number): Float32Array {
        return new Float32Array(this.exports.memory.buffer, pointer, count);
    }
    doubles(pointer: number, count: number): Float64Array {
        return new Float64Array(this.exports.memory.buffer, pointer, count);
    }

    /// Throws the error that a function returned, if any.
    check(error: number): void {
        if (error === 0) return;
        const text = this.text(this.call('domelight_error_text', error));
        this.call('domelight_error_free', error);
        throw new ModuleError(/[.!?]$/.test(text) ? text : `${text}.`);
    }
    text(pointer: number): string {
        const bytes = new Uint8Array(this.exports.memory.buffer, pointer);
        return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
    }

    /// Runs `work` with memory that is freed afterwards.
    scope<T>(work: (scope: Scope) => T): T {
        const scope = new Scope(this.exports);
        try {
            return work(scope);
        } finally {
            scope.free();
        }
    }
}

function exit(code: number): never {
    throw new ModuleError(`the module ended with status ${code}`);
}

class Scope {
    private readonly pointers: number[] = [];
    constructor(private readonly exports: Exports) {}
    /// Zeroed memory.
    bytes(count: number): number {
        const pointer = this.exports.malloc(count + 64);
        if (pointer === 0) throw new ModuleError('there is not enough memory for this environment');
        this.pointers.push(pointer);
        new Uint8Array(this.exports.memory.buffer, pointer, Math.min(count, 4096)).fill(0);
        return pointer;
    }
    string(text: string): number {
        const bytes = new TextEncoder().encode(text);
        const pointer = this.bytes(bytes.length + 1);
        new Uint8Array(this.exports.memory.buffer, pointer, bytes.length).set(bytes);
        return pointer;
    }
    free(): void {
        for (const pointer of this.pointers) this.exports.free(pointer);
    }
}

export interface EnvironmentFacts {
    format: string;
    projection: string;
    /// Of the lat-long map that holds as much.
    latlongHeight: number;
    /// 3 x 3 by rows: the light from direction d of the world is where the map has the direction worldToSource d.
    worldToSource: number[];
}
export interface Filtered {
    chain: Chain;
    /// The cosine integral E.
    irradiance?: CubeLevel;
    /// 9 x RGB, of the radiance.
    sh?: Float64Array;
}

/// An environment in the module's memory.
export class Environment {
    constructor(
        private readonly module: Module,
        private readonly handle: number,
    ) {}

    close(): void {
        this.module.call('domelight_environment_free', this.handle);
    }

    get info(): EnvironmentFacts {
        const m = this.module;
        return m.scope(scope => {
            const info = scope.bytes(k_info_bytes);
            m.words(info)[0] = k_info_bytes;
            m.check(m.call('domelight_environment_get_info', this.handle, info));
            const [, format, projection, , , , , latlongHeight] = m.words(info);
            return {format: m.text(format!), projection: m.text(projection!), latlongHeight: latlongHeight!, worldToSource: [...m.doubles(info + 32, 9)]};
        });
    }
    /// What was repaired, and what the file leaves open.
    get warnings(): string[] {
        const m = this.module, count = m.call('domelight_environment_warning_count', this.handle);
        return Array.from({length: count}, (_, k) => m.text(m.call('domelight_environment_warning', this.handle, k)));
    }
    /// The lat-long map in its own frame.
    latlong(): Latlong {
        const m = this.module;
        return m.scope(scope => {
            const image = scope.bytes(4), pixels = scope.bytes(k_pixels_bytes);
            m.check(m.call('domelight_environment_latlong', this.handle, image));
            m.call('domelight_pixels_init_sized', pixels, k_pixels_bytes);
            const made = m.words(image)[0]!;
            m.check(m.call('domelight_image_pixels', made, pixels));
            const [, data, width, height] = m.words(pixels), copy = m.floats(data!, 3 * width! * height!).slice();
            m.call('domelight_image_free', made);
            return {width: width!, height: height!, pixels: copy};
        });
    }
    /// The light itself as a cube, six faces of half floats.
    cube(size: number): CubeLevel {
        return this.prefilter('ggx', [size], [0], 0, 'centre').chain.levels[0]!;
    }

    /// A chain of cubes; with irradianceSize also the irradiance and nine harmonics. texels: made to be interpolated, or the light at their centres. mirrored: to be looked up at
    /// (-x, y, z).
    prefilter(lobe: Chain['lobe'], sizes: number[], parameters: number[], irradianceSize: number, texels: 'read' | 'centre' = 'read', mirrored = false): Filtered {
        const m = this.module;
        return m.scope(scope => {
            const levels = scope.bytes(k_level_bytes * sizes.length);
            const word = scope.string(lobe);
            sizes.forEach((size, k) => {
                const level = levels + k * k_level_bytes;
                m.call('domelight_level_init_sized', level, k_level_bytes);
                m.words(level)[1] = word;
                m.doubles(level + 8, 2)[lobe === 'ggx' ? 0 : 1] = parameters[k]!;
                m.words(level)[6] = size;
            });
            const options = scope.bytes(k_options_bytes);
            m.call('domelight_prefilter_options_init_sized', options, 52);
            const read = scope.string(texels);  // first: memory that grows leaves earlier views behind
            m.words(options)[2] = read;
            m.words(options).set([levels, sizes.length], 3);
            m.words(options).set([irradianceSize, irradianceSize > 0 ? 3 : 0, 1], 8);
            const turn = scope.bytes(72);
            m.doubles(turn, 9).set([-1, 0, 0, 0, 1, 0, 0, 0, 1]);
            if (mirrored) m.words(options)[7] = turn;
            const handle = scope.bytes(4);
            m.check(m.call('domelight_prefilter', this.handle, options, handle));
            const filtered = m.words(handle)[0]!;
            try {
                return this.collect(filtered, lobe, parameters, irradianceSize > 0);
            } finally {
                m.call('domelight_filtered_free', filtered);
            }
        });
    }

    /// The light in directions, three numbers each, without a map between: RGB of each. parameter: the roughness, or the exponent.
    inDirections(lobe: Lobe, parameter: number, directions: Float64Array): Float32Array {
        const m = this.module;
        return m.scope(scope => {
            const level = scope.bytes(k_level_bytes);
            m.call('domelight_level_init_sized', level, k_level_bytes);
            const word = scope.string(lobe);
            m.words(level)[1] = word;
            m.doubles(level + 8, 2)[lobe === 'ggx' ? 0 : 1] = parameter;
            m.words(level)[6] = 1;
            const places = scope.bytes(directions.byteLength);
            m.doubles(places, directions.length).set(directions);
            const options = scope.bytes(k_options_bytes);
            m.call('domelight_prefilter_options_init_sized', options, 52);
            m.words(options).set([level, 1, places, directions.length / 3], 3);
            const handle = scope.bytes(4);
            m.check(m.call('domelight_prefilter', this.handle, options, handle));
            const filtered = m.words(handle)[0]!, pixels = scope.bytes(k_pixels_bytes);
            try {
                m.call('domelight_pixels_init_sized', pixels, k_pixels_bytes);
                m.check(m.call('domelight_filtered_level', filtered, 0, pixels));
                return m.floats(m.words(pixels)[1]!, directions.length).slice();
            } finally {
                m.call('domelight_filtered_free', filtered);
            }
        });
    }

    private collect(filtered: number, lobe: Chain['lobe'], parameters: number[], more: boolean): Filtered {
        const m = this.module;
        return m.scope(scope => {
            const texture = scope.bytes(4);
            m.check(m.call('domelight_encode_filtered', filtered, 0, texture));
            const chain: Chain = {lobe, levels: m.levels(m.words(texture)[0]!), parameters};
            m.call('domelight_texture_free', m.words(texture)[0]!);
            if (!more) return {chain};
            const pixels = scope.bytes(k_pixels_bytes), count = scope.bytes(4);
            m.call('domelight_pixels_init_sized', pixels, k_pixels_bytes);
            m.check(m.call('domelight_filtered_irradiance_over_pi', filtered, pixels));
            // The pixels are this environment's own, and freed with it: they may become E in place.
            const [, data, width, height] = m.words(pixels);
            const e = m.floats(data!, 18 * width! * height!);
            e.forEach((v, k) => (e[k] = v * Math.PI));
            const sh = m.call('domelight_filtered_sh', filtered, count);
            return {chain, irradiance: m.encode(pixels), sh: m.doubles(sh, 27).slice()};
        });
    }
}
