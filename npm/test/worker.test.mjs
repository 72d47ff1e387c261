// The library in a worker of Node.
import assert from 'node:assert/strict';
import {test, after} from 'node:test';
import {pathToFileURL} from 'node:url';
import * as domelight from 'domelight';
import {load} from 'domelight/library';

const module = process.env.DOMELIGHT_WASM && pathToFileURL(process.env.DOMELIGHT_WASM);
if (module) domelight.configure({module});
after(() => domelight.terminate());

function sky(width = 256) {
    const data = Float32Array.from({length: 3 * width * width / 2}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024);
    return {data, width, height: width / 2};
}

test('the worker gives what this thread gives', async () => {
    const environment = await domelight.fromPixels(sky());
    assert.deepEqual([environment.width, environment.height, environment.projection], [256, 128, 'latlong']);
    const here = await load(module ? {module} : {});
    const expected = here.prefilter(here.fromPixels(sky()), {size: 32, levels: 3, irradianceSize: 8, shBands: 2});
    const progress = [];
    const found = await domelight.prefilter(environment, {size: 32, levels: 3, irradianceSize: 8, shBands: 2, progress: done => progress.push(done)});
    assert.deepEqual(found, expected);
    assert.ok(progress.length > 0);
    assert.deepEqual(await environment.radiance([0, 1, 0]), here.fromPixels(sky()).radiance([0, 1, 0]));
    environment.close();
    await assert.rejects(domelight.prefilter(environment), /has been closed/);
});

test('calls wait for each other, and errors have their fields', async () => {
    const environment = await domelight.fromPixels(sky());
    const [sh, error, table] = await Promise.all([
        domelight.sphericalHarmonics(environment, {bands: 3}),
        domelight.prefilter(environment, {lobe: 'blinn'}).catch(error => error),
        domelight.brdfTable({size: 4}),
    ]);
    assert.equal(sh.length, 27);
    assert.ok(error instanceof domelight.DomelightError);
    assert.equal(error.field, 'lobe');
    assert.equal(table.width, 4);
    const sampler = await domelight.Sampler.build(environment);
    assert.equal((await sampler.sample({count: 100})).pdf.length, 100);
});

test('an aborted call ends at once, and the next one works', async () => {
    const environment = await domelight.fromPixels(sky(1024));
    const controller = new AbortController(), start = performance.now();
    const call = domelight.bake(environment, {size: 1024, signal: controller.signal, progress: () => controller.abort()});
    await assert.rejects(call, {name: 'AbortError'});
    void start;
    const again = await domelight.sphericalHarmonics(environment, {bands: 1});
    assert.equal(again.length, 3);
    await assert.rejects(domelight.bake(environment, {signal: AbortSignal.abort()}), {name: 'AbortError'});
});

test('a worker that is ended in the middle of a bake is one sentence, and the next call starts another', async () => {
    const environment = await domelight.fromPixels(sky(1024));
    const call = domelight.bake(environment, {size: 1024, progress: () => domelight.terminate()});
    await assert.rejects(call, /^DomelightError: The worker ended in the middle of the work.*\. The next call starts another\.$/);
    assert.equal((await domelight.irradiance(environment, {size: 8})).data.length, 6 * 64 * 3);
});

test('what cannot be read is one sentence', async () => {
    await assert.rejects(domelight.read('/nowhere/studio.hdr'), {name: 'DomelightError', field: '/nowhere/studio.hdr'});
    await assert.rejects(domelight.read('http://127.0.0.1:1/studio.hdr'), /cannot be fetched/);
    await assert.rejects(domelight.read(12), /neither an ArrayBuffer nor a view/);
    await assert.rejects(domelight.fromPixels({data: new Float32Array(5), width: 2, height: 1}), /5 numbers, not 6/);
    await assert.rejects(domelight.prefilter(undefined), /not an environment/);
});
