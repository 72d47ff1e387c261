// The library in a worker: every call is a promise, and the page keeps moving. index.d.ts has the types, with units and shapes.

import {aborted, DomelightError} from './errors.js';
import {checkPixels} from './pixels.js';

export {DomelightError};

const isNode = typeof process === 'object' && !!process.versions?.node && !globalThis.Deno;
const settings = {module: undefined, files: undefined, bake: undefined, worker: undefined};

/// What the next worker is started with. Call it before anything else.
///
/// module   the WebAssembly module: a URL, its bytes, or a WebAssembly.Module; the default is domelight.wasm beside this file
/// files    the same of the module that read() uses; the default is domelight-files.wasm beside this file
/// bake     the same of the module that bakeFiles() and write() use; the default is domelight-bake.wasm beside this file
/// worker   the URL of worker.js; the default is the one beside this file
export function configure({module, files, bake, worker} = {}) {
    Object.assign(settings, {module, files, bake, worker});
}

/// A worker of browsers or of Node, by the few functions that are used of either.
async function startWorker(url) {
    if (isNode) {
        const {Worker} = await import('node:worker_threads');
        // A worker inherits the options of Node, and --input-type (of `node -e`) is none for files.
        const evaluated = process.execArgv.some(option => option.startsWith('--input-type'));
        const worker = new Worker(url, evaluated ? {execArgv: []} : {});
        worker.unref();
        return {
            listen: (onMessage, onEnd) => {
                worker.on('message', onMessage);
                worker.on('error', onEnd);
                worker.on('exit', () => onEnd());
            },
            post: (message, transfer) => worker.postMessage(message, transfer),
            busy: yes => (yes ? worker.ref() : worker.unref()),
            terminate: () => worker.terminate(),
        };
    }
    let worker;
    try {
        // Bundlers know a worker by this form alone, and then bundle what it imports.
        worker = settings.worker ? new Worker(url, {type: 'module'}) : new Worker(new URL('./worker.js', import.meta.url), {type: 'module'});
    } catch {
        // A page may not start a worker from another origin, but it may import from there.
        worker = new Worker(URL.createObjectURL(new Blob([`import ${JSON.stringify(String(url))};`], {type: 'text/javascript'})), {type: 'module'});
    }
    return {
        listen: (onMessage, onEnd) => {
            worker.addEventListener('message', ({data}) => onMessage(data));
            worker.addEventListener('error', event => onEnd(event));
        },
        post: (message, transfer) => worker.postMessage(message, transfer),
        busy: () => {},
        terminate: () => worker.terminate(),
    };
}

/// One worker at a time, and the calls that wait for it. A worker that ends takes its objects with it: they are made
/// again from what the page gave, when they are used the next time.
class Host {
    #queue = [];
    #current;
    #worker;
    #last = 0;
    /// Grows with each worker: the objects of an earlier one do not exist any more.
    generation = 0;

    /// Calls a function of worker.js. `prepare` makes what it is given, when its turn has come.
    call(name, prepare, {progress, signal, transfer} = {}) {
        if (signal !== undefined && signal !== null && typeof signal.addEventListener !== 'function')
            return Promise.reject(new DomelightError('is not an AbortSignal', 'signal'));
        if (signal?.aborted) return Promise.reject(aborted(signal));
        if (progress !== undefined && typeof progress !== 'function') return Promise.reject(new DomelightError('is not a function', 'progress'));
        return new Promise((resolve, reject) => {
            const call = {name, prepare, progress, signal, transfer, resolve, reject};
            call.onAbort = () => this.#abort(call);
            signal?.addEventListener('abort', call.onAbort);
            this.#queue.push(call);
            this.#next();
        });
    }

    async #next() {
        if (this.#current || this.#queue.length === 0) return;
        const call = this.#current = this.#queue.shift();
        try {
            if (!this.#worker) await this.#start();
            if (this.#current !== call) return;
            const given = await call.prepare(this);
            if (this.#current !== call) return;
            const reply = await this.#send(call.name, given, call);
            if (this.#current === call) this.#settle(call, () => call.resolve(reply));
        } catch (error) {
            if (this.#current === call) this.#settle(call, () => call.reject(error));
        }
    }

    #settle(call, how) {
        call.signal?.removeEventListener('abort', call.onAbort);
        this.#current = undefined;
        how();
        this.#next();
    }

    async #start() {
        const url = settings.worker ?? new URL('./worker.js', import.meta.url);
        const worker = await startWorker(url);
        this.#worker = worker;
        ++this.generation;
        await new Promise((resolve, reject) => {
            worker.listen(
                message => (message.ready ? resolve() : this.#receive(worker, message)),
                event => {
                    const why = event?.message ? ` (${event.message})` : '';
                    reject(new DomelightError(`The worker ${url} cannot be started${why}`, '', '`worker` of configure() names another place.'));
                    this.#ended(worker, why);
                });
        });
        const place = module => (module instanceof URL ? module.href : module);
        await this.#send('start', {module: place(settings.module), files: place(settings.files), bake: place(settings.bake)}, {});
    }

    /// Sends one message and waits for its answer. Also used by `prepare`, while its call has the worker.
    send(name, given, transfer) {
        return this.#send(name, given, {transfer});
    }
    #send(name, given, {progress, transfer}) {
        const worker = this.#worker, id = ++this.#last;
        if (!worker) return Promise.reject(new DomelightError('The worker ended before the work began', '', 'The next call starts another.'));
        return new Promise((resolve, reject) => {
            worker.waiting ??= new Map();
            try {
                worker.post({id, name, given}, transfer ?? []);
            } catch (error) {
                throw new DomelightError(`An argument of ${name}() cannot be given to the worker (${error.message})`);
            }
            worker.waiting.set(id, {resolve, reject, progress});
            worker.busy(true);
        });
    }

    #receive(worker, {id, reply, error, broken, progress}) {
        const waiting = worker.waiting?.get(id);
        if (!waiting || worker.stopped) return;
        if (progress) {
            try {
                waiting.progress?.(progress.done, progress.stage);
            } catch (thrown) {
                this.#stop(worker);
                waiting.reject(thrown);
            }
            return;
        }
        worker.waiting.delete(id);
        if (worker.waiting.size === 0) worker.busy(false);
        if (broken) this.#stop(worker);
        if (error) waiting.reject(new DomelightError(error.what, error.field, error.hint));
        else waiting.resolve(reply);
    }

    #stop(worker) {
        if (this.#worker === worker) this.#worker = undefined;
        worker.stopped = true;
        worker.terminate();
    }

    #ended(worker, why) {
        if (worker.stopped) return;
        if (this.#worker === worker) this.#worker = undefined;
        worker.stopped = true;
        for (const {reject} of worker.waiting?.values() ?? [])
            reject(new DomelightError(`The worker ended in the middle of the work${why}`, '', 'The next call starts another.'));
    }

    /// What is being computed can only be stopped by ending the worker: it reads no messages until it is done.
    #abort(call) {
        const place = this.#queue.indexOf(call);
        if (place >= 0) {
            this.#queue.splice(place, 1);
            call.signal.removeEventListener('abort', call.onAbort);
            call.reject(aborted(call.signal));
        } else if (this.#current === call) {
            if (this.#worker) this.#stop(this.#worker);
            this.#settle(call, () => call.reject(aborted(call.signal)));
        }
    }

    /// Whether the worker of that generation still runs.
    holds(generation) {
        return !!this.#worker && this.generation === generation;
    }

    /// Ends the worker, and with it all memory that it holds.
    terminate() {
        const worker = this.#worker;
        if (!worker) return;
        this.#ended(worker, ', because terminate() was called');
        worker.terminate();
    }
}

const host = new Host();

/// Ends the worker. The next call starts another; environments are opened again when they are used.
export const terminate = () => host.terminate();

/// An object in the worker. `make` makes it there, and returns {id, ...}.
class Remote {
    #id;
    #generation = -1;
    #make;
    #closed = false;
    constructor(make, first) {
        this.#make = make;
        if (first) this.#adopt(first);
    }
    #adopt({id}) {
        this.#id = id;
        this.#generation = host.generation;
    }
    #checkOpen() {
        if (this.#closed) throw new DomelightError('This object has been closed');
    }
    /// Its number in the worker that now runs; for `prepare`.
    async in(worker) {
        this.#checkOpen();
        if (this.#generation !== worker.generation) this.#adopt(await this.#make(worker));
        return this.#id;
    }
    /// Makes another of it, by more than `make` is given otherwise. The number of that one; for `prepare`.
    async another(worker, ...given) {
        this.#checkOpen();
        return (await this.#make(worker, ...given)).id;
    }
    /// Frees its memory.
    close() {
        if (this.#closed) return;
        this.#closed = true;
        const id = this.#id, generation = this.#generation;
        // Nothing is to be freed where the worker has ended, and no other is started for that.
        if (!host.holds(generation)) return;
        host.call('close', worker => ({id: worker.generation === generation ? id : -1})).catch(() => {});
    }
}

/// Light from every direction. read() and fromPixels() make one.
export class Environment extends Remote {
    constructor(make, {id, info, warnings}) {
        super(make, {id});
        Object.assign(this, info);
        this.openingWarnings = warnings;
    }
    /// Opens it once more, in the library that writes files. Its number there; for `prepare`.
    forBaking(worker) {
        return this.another(worker, true);
    }
    /// Radiance that arrives from a direction of three numbers: [r, g, b].
    radiance(direction) {
        return host.call('radiance', async worker => ({id: await this.in(worker), direction: [...direction]}));
    }
    /// All of it as a lat-long map of RGB floats: {data, width, height}.
    latlong() {
        return host.call('latlong', async worker => ({id: await this.in(worker)}));
    }
    /// Warnings about its file, and what was repaired, complete once it has been read.
    warnings() {
        return host.call('warnings', async worker => ({id: await this.in(worker)}));
    }
}

async function made(open, signal) {
    let first;
    await host.call('memory', async worker => {
        first = await open(worker);
        return {};
    }, {signal});
    return new Environment(open, first);
}

/// Bytes of what names a file: a URL or path, a Blob or File, a Response, or the bytes themselves.
async function load(source) {
    if (typeof source === 'string' || source instanceof URL) return loadUrl(source);
    if (typeof Response === 'function' && source instanceof Response) {
        if (!source.ok) throw new DomelightError(`cannot be fetched (HTTP ${source.status})`, source.url);
        return {bytes: await source.arrayBuffer(), name: fileName(source.url)};
    }
    if (typeof Blob === 'function' && source instanceof Blob) return {bytes: await source.arrayBuffer(), name: source.name};
    const {bytesOf} = await import('./library.js');
    const view = bytesOf(source);
    return {bytes: view.slice().buffer};
}

const fileName = url => decodeURIComponent(String(url).split(/[?#]/)[0].split('/').pop()) || undefined;

async function loadUrl(source) {
    const isPath = (isNode || globalThis.Deno) && !/^(https?|data|blob):/.test(String(source));
    if (isPath) {
        const {readFile} = await import('node:fs/promises');
        const bytes = await readFile(source).catch(error => {
            throw new DomelightError(`cannot be read (${error.code})`, String(source));
        });
        return {bytes: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), name: fileName(source)};
    }
    let response;
    try {
        response = await fetch(source);
    } catch (error) {
        throw new DomelightError(`cannot be fetched (${error.message})`, String(source));
    }
    if (!response.ok) throw new DomelightError(`cannot be fetched (HTTP ${response.status})`, String(source));
    return {bytes: await response.arrayBuffer(), name: fileName(source)};
}

export async function read(source, {signal, ...options} = {}) {
    if (signal?.aborted) throw aborted(signal);
    const {bytes, name} = await load(source);
    return made((worker, baking) => worker.send('read', {source: bytes, options: {name, ...options}, baking}), signal);
}

export async function fromPixels(pixels, {signal, ...options} = {}) {
    // The worker gets a copy, and so does this object, in case that the worker ends.
    const checked = checkPixels(pixels), copy = {...checked, data: checked.data.slice()};
    return made((worker, baking) => worker.send('fromPixels', {pixels: copy, options, baking}), signal);
}

function check(environment, kind = Environment) {
    if (!(environment instanceof kind)) throw new DomelightError('The first argument is not an environment', '', 'read() and fromPixels() make one.');
}

/// A call about an environment, whose options may have `progress` and `signal`.
function about(name) {
    return async (environment, {progress, signal, ...options} = {}) => {
        check(environment);
        return host.call(name, async worker => ({id: await environment.in(worker), options}), {progress, signal});
    };
}

export const prefilter = about('prefilter');
export const bake = about('bake');
export const irradiance = about('irradiance');
export const sphericalHarmonics = about('sphericalHarmonics');
export const lights = about('lights');

/// Everything that `domelight bake` writes for engines: [{name, data}].
export async function bakeFiles(environment, {progress, signal, ...options} = {}) {
    check(environment);
    return host.call('bakeFiles', async worker => ({id: await environment.forBaking(worker), options}), {progress, signal});
}

/// The bytes of one file: of encoded texels as bake() and encode() give them, of pixels, or of an environment as a lat-long map.
export async function write(what, {signal, ...options} = {}) {
    const given = what instanceof Environment ? async worker => ({id: await what.in(worker), options}) : () => ({what, options});
    return host.call('write', given, {signal});
}

export const brdfTable = ({signal, ...options} = {}) => host.call('brdfTable', () => ({options}), {signal});
export async function encode(levels, {signal, ...options} = {}) {
    const checked = (Array.isArray(levels) ? levels : [levels]).map(checkPixels);
    return host.call('encode', () => ({levels: checked, options}), {signal});
}

/// Bakes many cubes of one size, such as the probes of a scene that moves: what depends on the size alone is computed once.
export class ProbeFilter extends Remote {
    static async make({signal, ...options} = {}) {
        let first;
        const make = async worker => worker.send('probeFilter', {options});
        await host.call('memory', async worker => {
            first = await make(worker);
            return {};
        }, {signal});
        return new ProbeFilter(make, first);
    }
    /// What bake() gives of a cube's pixels: {data, width, height, faces: 6, channels}.
    async bake(pixels, {signal} = {}) {
        const checked = checkPixels(pixels);
        return host.call('bakeProbe', async worker => ({id: await this.in(worker), pixels: checked}), {signal});
    }
}

/// Draws light directions in proportion to the radiance.
export class Sampler extends Remote {
    static async build(environment, {signal, ...options} = {}) {
        check(environment);
        let first;
        const make = async worker => worker.send('sampler', {id: await environment.in(worker), options});
        await host.call('memory', async worker => {
            first = await make(worker);
            return {};
        }, {signal});
        return new Sampler(make, first);
    }
    /// Many directions at once: {u, v, x, y, z, r, g, b, pdf}, arrays of as many numbers.
    sample(points) {
        return host.call('sample', async worker => ({id: await this.in(worker), points}));
    }
    /// Radiance and density in directions: a Float32Array of three numbers each. {u, v, r, g, b, pdf}.
    lookUp(directions) {
        return host.call('lookUp', async worker => ({id: await this.in(worker), directions}));
    }
}
