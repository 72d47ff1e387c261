// Directions of their own, the module inside a script, and what close() leaves alone.
import assert from 'node:assert/strict';
import {test, after} from 'node:test';
import * as domelight from 'domelight';
import {load} from 'domelight/library';

after(() => domelight.terminate());
const data = Float32Array.from({length: 3 * 64 * 32}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024), pixels = {data, width: 64, height: 32};

test('light in directions is that of the texels in them', async () => {
    const environment = await domelight.fromPixels(pixels), levels = [{size: 8, roughness: 0.5}];
    const cube = await domelight.prefilter(environment, {levels});
    const place = k => [1, (2 * (k >> 3) + 1) / -8 + 1, (2 * (k & 7) + 1) / -8 + 1];  // of texel k of the face +X
    const {levels: [row]} = await domelight.prefilter(environment, {levels, directions: Array.from({length: 64}, (_, k) => place(k)).flat()});
    assert.deepEqual([row.width, row.height, row.faces], [64, 1, 1]);
    row.data.forEach((v, k) => assert.ok(Math.abs(v - cube.levels[0].data[k]) <= 1e-6 * v));
    await assert.rejects(domelight.prefilter(environment, {levels, directions: [1, 2]}), {field: 'directions'});
    environment.close();
});

test('the module of domelight/inline is domelight.wasm', async context => {
    const {module} = await import('domelight/inline').catch(() => ({}));
    if (!module) return context.skip('the package has been packed without it');
    const [inside, beside] = await Promise.all([load({module}), load()]);
    assert.deepEqual(inside.prefilter(inside.fromPixels(pixels), {size: 16, levels: 2}), beside.prefilter(beside.fromPixels(pixels), {size: 16, levels: 2}));
});

test('close() after terminate() starts no worker', async () => {
    const environment = await domelight.fromPixels(pixels);
    domelight.terminate();
    environment.close();
    await new Promise(resolve => setTimeout(resolve, 50));
    assert.equal(process.getActiveResourcesInfo().filter(name => name === 'MessagePort' || name === 'Worker').length, 0);
});
