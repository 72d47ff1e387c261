// The worker that index.js starts: one instance of the library, and the objects that the page holds by number.

import {DomelightError} from './errors.js';
import {load} from './library.js';

/// The library without decoders, the one with them, and the one that also writes files: each is larger than the one before, and loaded when it is first used.
let given = {};
let small, large, baking;
const smallLibrary = async () => (small ??= await load(given.module ? {module: given.module} : {}));
const largeLibrary = async () => (large ??= await load({module: given.files ?? new URL('./domelight-files.wasm', import.meta.url)}));
const bakingLibrary = async () => (baking ??= await load({module: given.bake ?? new URL('./domelight-bake.wasm', import.meta.url)}));
const objects = new Map();
let last = 0;

const keep = object => {
    objects.set(++last, object);
    return last;
};
const environment = id => objects.get(id);
/// The library that an environment is in.
const home = id => environment(id).library;

const calls = {
    start(settings) {
        given = settings;
    },
    async read({source, options, baking}) {
        const opened = (await (baking ? bakingLibrary() : largeLibrary())).read(source, options);
        return {id: keep(opened), info: opened.info, warnings: opened.warnings};
    },
    async fromPixels({pixels, options, baking}) {
        const opened = (await (baking ? bakingLibrary() : smallLibrary())).fromPixels(pixels, options);
        return {id: keep(opened), info: opened.info, warnings: []};
    },
    close({id}) {
        objects.get(id)?.close();
        objects.delete(id);
    },
    prefilter: ({id, options}, progress) => home(id).prefilter(environment(id), {...options, progress}),
    bake: ({id, options}, progress) => home(id).bake(environment(id), {...options, progress}),
    /// `id`: an environment that was opened for this, in the library that writes files.
    bakeFiles({id, options}, progress) {
        try {
            return home(id).bakeFiles(environment(id), {...options, progress});
        } finally {
            calls.close({id});
        }
    },
    /// `id`: the environment that is written in place of `what`.
    write: async ({id, what, options}) => (await bakingLibrary()).write(id === undefined ? what : environment(id), options),
    irradiance: ({id, options}) => home(id).irradiance(environment(id), options),
    sphericalHarmonics: ({id, options}) => home(id).sphericalHarmonics(environment(id), options),
    lights: ({id, options}) => home(id).lights(environment(id), options),
    radiance: ({id, direction}) => environment(id).radiance(direction),
    latlong: ({id}) => environment(id).latlong(),
    warnings: ({id}) => environment(id).warnings,
    brdfTable: async ({options}) => (large ?? await smallLibrary()).brdfTable(options),
    encode: async ({levels, options}) => (large ?? await smallLibrary()).encode(levels, options),
    probeFilter: async ({options}) => ({id: keep((await smallLibrary()).probeFilter(options))}),
    bakeProbe: ({id, pixels}) => objects.get(id).bake(pixels),
    sampler: ({id, options}) => ({id: keep(home(id).sampler(environment(id), options))}),
    sample: ({id, points}) => objects.get(id).sample(points),
    lookUp: ({id, directions}) => objects.get(id).lookUp(directions),
    memory: () => [small, large, baking].reduce((sum, library) => sum + (library?.memoryBytes ?? 0), 0),
};

/// All array buffers in a value, which are handed over and not copied.
function buffersOf(value, found = []) {
    if (ArrayBuffer.isView(value)) found.push(value.buffer);
    else if (value && typeof value === 'object') for (const inner of Object.values(value)) buffersOf(inner, found);
    return found;
}

const isNode = typeof process === 'object' && !!process.versions?.node && !globalThis.Deno;
let port = globalThis;
const send = (message, transfer = []) => port.postMessage(message, transfer);

async function answer({id, name, given}) {
    try {
        const reply = await calls[name](given, (done, stage) => send({id, progress: {done, stage}}));
        send({id, reply}, [...new Set(buffersOf(reply))]);
    } catch (error) {
        const {what, field, hint} = error instanceof DomelightError ? error : {what: String(error?.message ?? error), field: '', hint: ''};
        send({id, error: {what, field, hint}, broken: [small, large, baking].some(library => library?.broken)});
    }
}

// Without `await` at the top level, which bundlers refuse in workers of their default form.
if (isNode) {
    import('node:worker_threads').then(({parentPort}) => {
        port = parentPort;
        port.on('message', answer);
        send({ready: true});
    });
} else {
    port.addEventListener('message', ({data}) => answer(data));
    send({ready: true});
}
