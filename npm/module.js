// The WebAssembly module and its memory: how values go in and out. library.js is built on it.

import {camelCase, DomelightError} from './errors.js';
import {pixelsStruct} from './layout.js';

/// A module that wraps a function of JavaScript as one of WebAssembly, (i32, i32, f64) -> i32, which a table can hold:
/// one type, the import "m" "f", and its export "f".
const wrapper = new Uint8Array([
    0, 97, 115, 109, 1, 0, 0, 0, 1, 8, 1, 96, 3, 127, 127, 124, 1, 127, 2, 7, 1, 1, 109, 1, 102, 0, 0, 7, 5, 1, 1, 102, 0, 0,
]);

const isNode = typeof process === 'object' && !!process.versions?.node;

/// Compiles what `source` is: a WebAssembly.Module, its bytes, or a URL.
export async function compile(source) {
    if (source instanceof WebAssembly.Module) return source;
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return compiled(WebAssembly.compile(source), 'the bytes that `module` holds');
    if (typeof source !== 'string' && !(source instanceof URL)) throw new DomelightError(`${source} is neither a URL, bytes nor a WebAssembly.Module`, 'module');
    const url = new URL(source, globalThis.location?.href ?? import.meta.url);
    if (isNode && url.protocol === 'file:') {
        const {readFile} = await import('node:fs/promises');
        const bytes = await readFile(url).catch(error => {
            throw new DomelightError(`The WebAssembly module ${url} cannot be read (${error.code})`, '', '`module` names another place.');
        });
        return compiled(WebAssembly.compile(bytes), url);
    }
    let response;
    try {
        response = await fetch(url);
    } catch (error) {
        throw new DomelightError(`The WebAssembly module ${url} cannot be fetched (${error.message})`, '', '`module` names another place.');
    }
    if (!response.ok)
        throw new DomelightError(`The WebAssembly module ${url} cannot be fetched (HTTP ${response.status})`, '', '`module` names another place.');
    return compiled(response.arrayBuffer().then(bytes => WebAssembly.compile(bytes)), url);
}

async function compiled(promise, name) {
    try {
        return await promise;
    } catch (error) {
        throw new DomelightError(`${name} is not a WebAssembly module that this program can run (${error.message})`, '',
                                 'It needs WebAssembly with SIMD: Chrome 91, Firefox 89, Safari 16.4, Node 16.4 or later.');
    }
}

/// One instance: its own memory. Addresses are numbers. Views of the memory are made anew for each use, since it may have grown.
export class Instance {
    constructor(exports) {
        this.exports = exports;
        this.words = new Map();
        this.broken = undefined;
        this.messages = '';
    }

    static async create(module) {
        const instance = new Instance();
        const {exports} = await WebAssembly.instantiate(module, instance.#imports(module));
        instance.exports = exports;
        exports._initialize();
        return instance;
    }

    /// The module opens no files, and has its clock from here; what its C library would write before it ends itself is kept as the message of the error.
    #imports(module) {
        const imports = {};
        for (const {module: from, name} of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = () => 8;
        imports.wasi_snapshot_preview1 ??= {};
        imports.wasi_snapshot_preview1.fd_write = (_, vectors, count, written) => {
            let bytes = 0;
            vectors >>>= 0;
            written >>>= 0;
            for (let k = 0; k < count; ++k) {
                const view = this.view();
                const at = view.getUint32(vectors + 8 * k, true), size = view.getUint32(vectors + 8 * k + 4, true);
                this.messages += new TextDecoder().decode(this.bytes(at, size));
                bytes += size;
            }
            this.view().setUint32(written, bytes, true);
            return 0;
        };
        // Nanoseconds, of whichever clock: manifests of bakes state how long the stages took.
        imports.wasi_snapshot_preview1.clock_time_get = (_, __, result) => {
            this.view().setBigUint64(result >>> 0, BigInt(Math.round(1e6 * performance.now())), true);
            return 0;
        };
        imports.wasi_snapshot_preview1.proc_exit = () => {
            throw new WebAssembly.RuntimeError('the module ended itself');
        };
        return imports;
    }

    view() {
        return new DataView(this.exports.memory.buffer);
    }
    bytes(address, size) {
        return new Uint8Array(this.exports.memory.buffer, address, size);
    }

    /// Calls a function of the C interface. A trap ends the instance: its memory is in an unknown state.
    call(name, ...args) {
        if (this.broken) throw this.broken;
        try {
            // Addresses come as signed numbers; they are unsigned. All other results are counts.
            const result = this.exports[name](...args);
            return typeof result === 'number' ? result >>> 0 : result;
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError || error instanceof RangeError)) throw error;
            this.broken = new DomelightError(`The WebAssembly module ended during ${name.replace('domelight_', '')}: not enough memory, or a fault`, '',
                                             'Smaller images or sizes need less. A new instance is made for the next call.');
            this.broken.fatal = true;
            this.broken.cause = error;
            throw this.broken;
        }
    }

    /// Calls a function that returns a domelight_error*, and throws what it is.
    run(name, ...args) {
        const error = this.call(name, ...args);
        if (!error) return;
        const text = which => camelCase(this.text(this.call(`domelight_error_${which}`, error)));
        const thrown = new DomelightError(text('message'), text('where'), text('hint'));
        const cancelled = this.call('domelight_error_is_cancelled', error);
        this.call('domelight_error_free', error);
        if (cancelled) throw Object.assign(new Error(), {cancelled: true});
        throw thrown;
    }

    text(address) {
        address >>>= 0;
        const all = new Uint8Array(this.exports.memory.buffer);
        return address ? new TextDecoder().decode(all.slice(address, all.indexOf(0, address))) : '';
    }

    allocate(size) {
        const address = this.call('malloc', Math.max(size, 1));
        if (!address) throw new DomelightError(`There is no memory for ${size} bytes`);
        return address;
    }

    /// Calls `use` with a scope whose allocations end with it.
    scope(use) {
        const scope = new Scope(this);
        try {
            return use(scope);
        } finally {
            scope.free();
        }
    }

    /// A function of JavaScript, (data, stage, done) => 0 to go on, as the address that a domelight_progress is.
    functionAddress(callback) {
        const {f} = new WebAssembly.Instance(new WebAssembly.Module(wrapper), {m: {f: callback}}).exports;
        const table = this.exports.__indirect_function_table;
        this.slot ??= table.grow(1);
        table.set(this.slot, f);
        return this.slot;
    }
}

class Scope {
    constructor(instance) {
        this.instance = instance;
        this.addresses = [];
    }

    free() {
        if (this.instance.broken) return;
        for (const address of this.addresses) this.instance.exports.free(address);
    }

    bytes(size) {
        const address = this.instance.allocate(size);
        this.addresses.push(address);
        return address;
    }
    copy(array) {
        const address = this.bytes(array.byteLength);
        this.instance.bytes(address, array.byteLength).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
        return address;
    }
    text(text) {
        return this.copy(new TextEncoder().encode(`${text}\0`));
    }
    /// A word of the library, or null for its default.
    word(text, field) {
        if (text === undefined || text === null) return 0;
        if (typeof text !== 'string') throw new DomelightError('is not a text', field);
        return this.text(text);
    }
    /// A struct with `values`, its other fields 0.
    struct(struct, values) {
        const address = this.bytes(struct.size);
        this.instance.bytes(address, struct.size).fill(0);
        struct.write(this.instance.view(), address, {structSize: struct.size, ...values});
        return address;
    }
    /// A struct with the library's defaults and `values` in place of some of them.
    options(name, struct, values) {
        const address = this.bytes(struct.size);
        this.instance.call(`domelight_${name}_init_sized`, address, struct.size);
        struct.write(this.instance.view(), address, values);
        return address;
    }
    /// What a function writes to an address that is its last argument: a handle.
    handle(name, ...args) {
        const address = this.bytes(4);
        this.instance.view().setUint32(address, 0, true);
        this.instance.run(name, ...args, address);
        return this.instance.view().getUint32(address, true);
    }
    /// Pixels that a function describes by its last argument, copied: {data, width, height, faces, channels}.
    pixels(name, ...args) {
        const address = this.struct(pixelsStruct, {});
        this.instance.run(name, ...args, address);
        const {data, width, height, faces, channels} = pixelsStruct.read(this.instance.view(), address);
        const floats = width * height * faces * channels;
        return {data: new Float32Array(this.instance.exports.memory.buffer, data, floats).slice(), width, height, faces, channels};
    }
}
