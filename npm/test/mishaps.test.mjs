// What goes wrong around the library: workers that end, modules that cannot be had, signals, calls at once, objects that are used after their end.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import {after, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import * as domelight from 'domelight';
import {load} from 'domelight/library';

after(() => domelight.terminate());
const sky = (width = 128) => ({data: Float32Array.from({length: 3 * width * width / 2}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024), width, height: width / 2});
const sentence = (words, field = '') => error => {
    assert.equal(error.name, 'DomelightError', error.stack);
    assert.match(error.message, words);
    assert.match(error.message, /[.!?]$/);
    assert.equal(error.field, field);
    return true;
};
const workers = () => process.getActiveResourcesInfo().filter(name => name === 'MessagePort' || name === 'Worker').length;
const pause = ms => new Promise(resolve => setTimeout(resolve, ms));

/// Serves the package's files, some of them with faults, while `use` runs.
async function served(answers, use) {
    const server = http.createServer((request, response) => {
        const answer = answers[request.url];
        response.writeHead(answer?.status ?? 200, {'content-type': answer?.type ?? 'application/wasm'});
        response.end(answer?.body ?? '');
    });
    await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
    try {
        return await use(`http://127.0.0.1:${server.address().port}`);
    } finally {
        server.close();
    }
}
/// With other settings, and back.
async function configured(settings, use) {
    domelight.terminate();
    domelight.configure(settings);
    try {
        return await use();
    } finally {
        domelight.terminate();
        domelight.configure();
    }
}
const wasm = fs.readFileSync(fileURLToPath(import.meta.resolve('domelight/domelight.wasm')));

test('a module that cannot be fetched is one sentence, in each of its places', async () => {
    const answers = {'/404.wasm': {status: 404}, '/500.wasm': {status: 500}, '/page.wasm': {body: '<!doctype html>', type: 'text/html'},
                     '/cut.wasm': {body: wasm.subarray(0, 5000)}, '/empty.wasm': {}, '/plain.wasm': {body: wasm, type: 'text/plain'}};
    await served(answers, async origin => {
        for (const [file, words] of [['/404.wasm', /404\.wasm cannot be fetched \(HTTP 404\)/], ['/500.wasm', /HTTP 500/], ['/page.wasm', /page\.wasm is not a WebAssembly module/],
                                     ['/cut.wasm', /cut\.wasm is not a WebAssembly module/], ['/empty.wasm', /empty\.wasm is not a WebAssembly module/]]) {
            await configured({module: origin + file}, () => assert.rejects(domelight.fromPixels(sky()), sentence(words)));
            await configured({files: origin + file}, () => assert.rejects(domelight.read(Buffer.from('#?RADIANCE')), sentence(words)));
            await configured({bake: origin + file}, () => assert.rejects(domelight.write([sky(8)]), sentence(words)));
        }
        // A server that does not know the type is no obstacle.
        await configured({module: `${origin}/plain.wasm`}, async () => assert.equal((await domelight.fromPixels(sky())).width, 128));
    });
    await configured({module: 'http://127.0.0.1:1/domelight.wasm'}, () => assert.rejects(domelight.fromPixels(sky()), sentence(/cannot be fetched/)));
    await configured({module: 12}, () => assert.rejects(domelight.fromPixels(sky()), sentence(/12/, 'module')));
    assert.equal((await domelight.fromPixels(sky())).width, 128, 'the next call works');
});

test('a worker that cannot be started is one sentence', async () => {
    await configured({worker: new URL('file:///nowhere/worker.js')}, () => assert.rejects(domelight.fromPixels(sky()), sentence(/^The worker file:\/\/\/nowhere\/worker\.js cannot be started/)));
    assert.equal((await domelight.fromPixels(sky())).width, 128);
});

test('a signal before, in and after the work; the listeners are gone after it', async () => {
    const environment = await domelight.fromPixels(sky(1024));
    await assert.rejects(domelight.bake(environment, {signal: AbortSignal.abort()}), {name: 'AbortError'});
    await assert.rejects(domelight.bake(environment, {signal: AbortSignal.abort(new Error('no time'))}), /^Error: no time$/);
    const controller = new AbortController(), {signal} = controller;
    let listening = 0;
    const {addEventListener: add, removeEventListener: remove} = signal;
    signal.addEventListener = (...given) => (++listening, add.apply(signal, given));
    signal.removeEventListener = (...given) => (--listening, remove.apply(signal, given));
    await domelight.sphericalHarmonics(environment, {signal});
    assert.equal(listening, 0);
    const waiting = [domelight.bake(environment, {size: 1024, signal}), domelight.bake(environment, {size: 1024, signal})];
    setTimeout(() => controller.abort(), 20);
    for (const {status, reason} of await Promise.allSettled(waiting)) assert.deepEqual([status, reason.name], ['rejected', 'AbortError']);
    assert.equal(listening, 0);
    controller.abort();  // after all
    for (const call of [() => domelight.read(Buffer.from(''), {signal}), () => domelight.fromPixels(sky(), {signal}), () => domelight.write([sky(8)], {signal}),
                        () => domelight.encode([sky(8)], {signal}), () => domelight.brdfTable({signal}), () => domelight.Sampler.build(environment, {signal}),
                        () => domelight.ProbeFilter.make({size: 32, signal}), () => domelight.bakeFiles(environment, {signal})])
        await assert.rejects(call(), {name: 'AbortError'});
    await assert.rejects(domelight.bake(environment, {signal: {}}), sentence(/is not an AbortSignal/, 'signal'));
    assert.equal((await domelight.sphericalHarmonics(environment, {bands: 1})).length, 3);
    environment.close();
});

test('close() after an abort starts no worker, and may be called twice', async () => {
    domelight.terminate();
    const environment = await domelight.fromPixels(sky(1024)), controller = new AbortController();
    setTimeout(() => controller.abort(), 20);
    await assert.rejects(domelight.bake(environment, {size: 1024, signal: controller.signal}), {name: 'AbortError'});
    environment.close();
    environment.close();
    await pause(50);
    assert.equal(workers(), 0);
    await assert.rejects(domelight.bake(environment), sentence(/has been closed/));
    await assert.rejects(environment.radiance([0, 1, 0]), sentence(/has been closed/));
    const sampler = await domelight.Sampler.build(await domelight.fromPixels(sky())), probes = await domelight.ProbeFilter.make({size: 32});
    for (const object of [sampler, probes]) {
        object.close();
        object.close();
    }
    await assert.rejects(sampler.sample({count: 4}), sentence(/has been closed/));
    await assert.rejects(probes.bake({data: new Float32Array(6 * 32 * 32 * 3), width: 32, height: 32, faces: 6}), sentence(/has been closed/));
    domelight.terminate();
    domelight.terminate();
});

test('two bakes at once are those of one after the other', async () => {
    const [a, b] = await Promise.all([domelight.fromPixels(sky(128)), domelight.fromPixels(sky(256))]), options = {size: 32, levels: 3};
    const both = await Promise.all([domelight.bake(a, options), domelight.bake(b, options), domelight.bake(a, options)]);
    const dl = await load();
    for (const [k, width] of [128, 256, 128].entries()) assert.deepEqual(both[k], dl.bake(dl.fromPixels(sky(width)), options));
    a.close();
    b.close();
});

test('wrong pixels are one sentence', async () => {
    const faulty = (change, words, field) => assert.rejects(domelight.fromPixels({...sky(8), ...change}), sentence(words, field));
    const {data} = sky(8), moved = data.slice();
    structuredClone(moved.buffer, {transfer: [moved.buffer]});
    await faulty({data: moved}, /0 numbers.*transferred/, 'data');
    for (const wrong of [new Float64Array(data), new Uint8Array(data.length), new Int16Array(data.length), [...data], data.buffer, undefined, null, 'text', 12, {length: 96}])
        await faulty({data: wrong}, /is neither a Float32Array nor a Uint16Array of half floats/, 'data');
    await faulty({data: data.subarray(3)}, /93 numbers, not 96/, 'data');
    for (const [name, value] of [['width', 0], ['width', 8.5], ['height', -4], ['channels', NaN], ['faces', '6'], ['faces', 2]]) await assert.rejects(domelight.fromPixels({...sky(8), [name]: value}), {name: 'DomelightError'});
    for (const value of [NaN, Infinity, -Infinity, -1]) {
        const bad = data.slice();
        bad[31] = value;
        await faulty({data: bad}, /texel \(2, 1\)/, '');
    }
    const halves = new Uint16Array(data.length).fill(0x3c00);
    halves[5] = 0x7e00;
    await faulty({data: halves}, /texel \(1, 0\)/, '');
    await assert.rejects(domelight.fromPixels(), sentence(/is neither a Float32Array/, 'data'));
    await assert.rejects(domelight.fromPixels(sky(8), {worldToSource: [1, 2]}), sentence(/nine numbers/, 'worldToSource'));
    await assert.rejects(domelight.encode([{...sky(8), data: moved}]), sentence(/transferred/, 'data'));
    await assert.rejects(domelight.encode(undefined), {name: 'DomelightError'});
    await assert.rejects(domelight.encode([undefined]), {name: 'DomelightError'});
    const sampler = await domelight.Sampler.build(await domelight.fromPixels(sky()));
    await assert.rejects(sampler.sample(new Uint32Array(3)), sentence(/are not pairs/, 'points'));
    await assert.rejects(sampler.sample({count: 0}), sentence(/0 is not a number of points/, 'count'));
    await assert.rejects(sampler.lookUp(new Float64Array(3)), sentence(/Float32Array/, 'directions'));
    const shared = typeof SharedArrayBuffer === 'function' && new Float32Array(new SharedArrayBuffer(4 * data.length)).fill(1);
    if (shared) assert.equal((await domelight.fromPixels({...sky(8), data: shared})).width, 8);
});

test('files that are gone, empty or no files are one sentence', async () => {
    const buffer = new Uint8Array(100);
    structuredClone(buffer.buffer, {transfer: [buffer.buffer]});
    await assert.rejects(domelight.read(buffer), sentence(/transferred/));
    await assert.rejects(domelight.read(new Uint8Array(0)), {name: 'DomelightError'});
    await assert.rejects(domelight.read(new Blob([])), {name: 'DomelightError'});
    await assert.rejects(domelight.read(new Response('', {status: 403})), sentence(/HTTP 403/));
    for (const wrong of [undefined, null, 12, {}, []]) await assert.rejects(domelight.read(wrong), sentence(/The file is neither/));
    await served({'/gone.hdr': {status: 410}}, origin => assert.rejects(domelight.read(`${origin}/gone.hdr`), error => sentence(/HTTP 410/, error.field)(error) && error.field.endsWith('gone.hdr')));
});

test('a process whose work is done ends, whatever is left open', async () => {
    const code = `import * as domelight from 'domelight';
        const environment = await domelight.fromPixels({data: new Float32Array(96).fill(1), width: 8, height: 4});
        await domelight.bake(environment, {size: 8});
        const controller = new AbortController();
        const call = domelight.bake(environment, {size: 512, signal: controller.signal}).catch(() => {});
        setTimeout(() => controller.abort(), 5);
        await call;
        console.log('done');`;
    const output = await new Promise((resolve, reject) => execFile(process.execPath, ['--input-type=module', '-e', code], {cwd: fileURLToPath(new URL('.', import.meta.url)), timeout: 60_000},
                                                                   (error, stdout) => (error ? reject(error) : resolve(stdout))));
    assert.equal(output, 'done\n');
});
