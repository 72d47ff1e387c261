// The worker that index.js starts: one instance of the library, and the objects that the page holds by number.

import {DomelightError} from './errors.js';
import {load} from './library.js';

let library;
const objects = new Map();
let last = 0;

const keep = object => {
    objects.set(++last, object);
    return last;
};
const environment = id => objects.get(id);

const calls = {
    async start({module}) {
        library = await load(module ? {module} : {});
        return {version: library.version};
    },
    async read({source, options}) {
        const opened = library.read(source, options);
        return {id: keep(opened), info: opened.info, warnings: opened.warnings};
    },
    fromPixels({pixels, options}) {
        const opened = library.fromPixels(pixels, options);
        return {id: keep(opened), info: opened.info, warnings: []};
    },
    close({id}) {
        objects.get(id)?.close();
        objects.delete(id);
    },
    prefilter: ({id, options}, progress) => library.prefilter(environment(id), {...options, progress}),
    bake: ({id, options}, progress) => library.bake(environment(id), {...options, progress}),
    irradiance: ({id, options}) => library.irradiance(environment(id), options),
    sphericalHarmonics: ({id, options}) => library.sphericalHarmonics(environment(id), options),
    lights: ({id, options}) => library.lights(environment(id), options),
    radiance: ({id, direction}) => environment(id).radiance(direction),
    latlong: ({id}) => environment(id).latlong(),
    warnings: ({id}) => environment(id).warnings,
    brdfTable: ({options}) => library.brdfTable(options),
    encode: ({levels, options}) => library.encode(levels, options),
    sampler: ({id, options}) => ({id: keep(library.sampler(environment(id), options))}),
    sample: ({id, points}) => objects.get(id).sample(points),
    lookUp: ({id, directions}) => objects.get(id).lookUp(directions),
    memory: () => library.memoryBytes,
};

/// All array buffers in a value, which are handed over and not copied.
function buffersOf(value, found = []) {
    if (ArrayBuffer.isView(value)) found.push(value.buffer);
    else if (value && typeof value === 'object') for (const inner of Object.values(value)) buffersOf(inner, found);
    return found;
}

const isNode = typeof process === 'object' && !!process.versions?.node && !globalThis.Deno;
const port = isNode ? (await import('node:worker_threads')).parentPort : globalThis;
const send = (message, transfer = []) => port.postMessage(message, transfer);

async function answer({id, name, given}) {
    try {
        const reply = await calls[name](given, (done, stage) => send({id, progress: {done, stage}}));
        send({id, reply}, [...new Set(buffersOf(reply))]);
    } catch (error) {
        const {what, field, hint} = error instanceof DomelightError ? error : {what: String(error?.message ?? error), field: '', hint: ''};
        send({id, error: {what, field, hint}, broken: !!library?.broken});
    }
}

if (isNode) port.on('message', answer);
else port.addEventListener('message', ({data}) => answer(data));
send({ready: true});
