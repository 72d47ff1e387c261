// The library on this thread. DOMELIGHT_WASM names another module than the one beside the package's files.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';
import {load} from 'domelight/library';

const options = process.env.DOMELIGHT_WASM ? {module: pathToFileURL(process.env.DOMELIGHT_WASM)} : {};
const dl = await load(options);

const constant = (value, width = 64) => ({data: new Float32Array(3 * width * width / 2).fill(value), width, height: width / 2});
/// A bright patch in a dim sky, the same in every run.
function patch(width = 128) {
    const pixels = constant(0.25, width);
    for (let k = 0; k < 60; ++k) pixels.data[3 * (20 * width + 30) + k] = 50;
    return pixels;
}
const refusal = (field, words) => error => {
    assert.equal(error.name, 'DomelightError');
    assert.equal(error.field, field);
    assert.match(error.message, words);
    assert.match(error.message, /[.!?]$/);
    return true;
};

test('constant light stays constant in every level, in irradiance and in harmonics', () => {
    const environment = dl.fromPixels(constant(2));
    const {levels, irradianceOverPi, sh, mean} = dl.prefilter(environment, {size: 32, levels: 4, irradianceSize: 8, shBands: 3});
    assert.deepEqual(levels.map(level => [level.width, level.faces, level.roughness]), [[32, 6, 0], [16, 6, 1 / 3], [8, 6, 2 / 3], [4, 6, 1]]);
    for (const {data} of [...levels, irradianceOverPi]) for (const value of data) assert.ok(Math.abs(value / 2 - 1) < 1e-5);
    assert.equal(sh.length, 27);
    assert.ok(Math.abs(sh[0] - 2 * Math.sqrt(4 * Math.PI)) < 1e-5);
    assert.ok(Math.abs(mean[1] - 2) < 1e-6);
    environment.close();
    assert.throws(() => dl.prefilter(environment), /closed/);
});

test('a cube of half floats is read as one of floats', () => {
    const data = new Uint16Array(6 * 16 * 16 * 3).fill(0x4000);  // 2
    const {levels} = dl.prefilter(dl.fromPixels({data, width: 16, height: 16, faces: 6}), {size: 16, levels: 2});
    for (const value of levels[1].data) assert.ok(Math.abs(value / 2 - 1) < 1e-5);
});

test('bake encodes what an engine loads', () => {
    const {levels, specs, encoding, faces} = dl.bake(dl.fromPixels(patch()), {engine: 'three', size: 64});
    assert.equal(encoding, 'rgba16f');
    assert.equal(faces, 6);
    assert.deepEqual(levels.map(level => level.data.length), [64, 32, 16, 8].map(size => size * size * 6 * 8));
    assert.ok(Math.abs(specs[1].roughness - (1 - Math.sqrt(2 / 3))) < 1e-12);
});

test('half floats are the nearest ones, ties to even, down to the smallest', () => {
    const half = k => ((k >> 10) === 0 ? (k & 1023) * 2 ** -24 : (1024 + (k & 1023)) * 2 ** ((k >> 10) - 25));
    const bits = new Uint32Array(1), float = new Float32Array(bits.buffer), values = [], expected = [];
    const add = (value, k) => (values.push(value), expected.push(k));
    for (let k = 0; k < 0x7bff; ++k) {
        float[0] = (half(k) + half(k + 1)) / 2;  // exact
        const middle = float[0];
        add(half(k), k);
        add(middle, k + (k & 1));
        ++bits[0];
        add(float[0], k + 1);
        bits[0] -= 2;
        add(float[0], k);
    }
    add(65504, 0x7bff);
    add(1e9, 0x7bff);  // clipped
    while (values.length % 24) add(1, 0x3c00);
    const {levels: [{data, clippedTexels}]} = dl.encode({data: Float32Array.from(values), width: values.length / 6, height: 2}, {encoding: 'rgba16f'});
    const stored = new Uint16Array(data.buffer).filter((_, i) => i % 4 !== 3);
    assert.equal(stored.findIndex((v, i) => v !== expected[i]), -1);
    assert.equal(clippedTexels, 1);
});

test('samples have the density that a lookup states, and look up their radiance', () => {
    const sampler = dl.sampler(dl.fromPixels(patch()));
    const drawn = sampler.sample({count: 512, sequence: 'sobol', seed: 7});
    const directions = new Float32Array(3 * 512);
    for (let k = 0; k < 512; ++k) directions.set([drawn.x[k], drawn.y[k], drawn.z[k]], 3 * k);
    const found = sampler.lookUp(directions);
    for (let k = 0; k < 512; ++k) assert.ok(Math.abs(found.pdf[k] / drawn.pdf[k] - 1) < 1e-2, `${k}: ${found.pdf[k]} ${drawn.pdf[k]}`);
});

test('the BRDF table of a rough white metal is what its formula gives', () => {
    const {data, width, channels} = dl.brdfTable({size: 8});
    assert.deepEqual([width, channels], [8, 3]);
    for (let k = 0; k < data.length; k += 3) assert.ok(data[k] >= 0 && data[k + 1] >= 0 && data[k] + data[k + 1] <= 1.00001);
});

test('a sun in a sky is found as a light', () => {
    const sky = constant(0.25, 256);
    for (let k = 0; k < 6; ++k) sky.data[3 * (40 * 256 + 100) + k] = sky.data[3 * (41 * 256 + 100) + k] = 20000;
    const lights = dl.lights(dl.fromPixels(sky));
    assert.equal(lights.length, 1);
    assert.ok(Math.abs(Math.hypot(...lights[0].direction) - 1) < 1e-9);
});

test('errors name the option and say what it may be', () => {
    const environment = dl.fromPixels(constant(1));
    assert.throws(() => dl.prefilter(environment, {irradianceSize: 5000}), refusal('irradianceSize', /0 to 4096/));
    assert.throws(() => dl.prefilter(environment, {lobe: 'blinn'}), refusal('lobe', /ggx, charlie, phong/));
    assert.throws(() => dl.prefilter(environment, {levels: [{roughness: 1}]}), refusal('levels', /size/));
    assert.throws(() => dl.prefilter(environment, {size: 0}), refusal('size', /1 to 16384/));
    assert.throws(() => dl.prefilter(environment, {rougness: []}), refusal('rougness', /is not an option/));
    assert.throws(() => dl.prefilter({}), refusal('', /not an environment/));
    assert.throws(() => dl.bake(environment, {engine: 'doom'}), refusal('engine', /Known: generic, three/));
    assert.throws(() => dl.encode([constant(1)], {encoding: 'astc6x6-hdr'}), refusal('encoding', /WebAssembly/));
    assert.throws(() => dl.brdfTable({size: 2.5}), refusal('size', /whole number/));
});

test('a wrong array is refused in one sentence', () => {
    const sky = data => dl.fromPixels({data, width: 4, height: 2});
    assert.throws(() => sky(new Float32Array(23)), refusal('data', /23 numbers, not 24/));
    assert.throws(() => sky(new Float64Array(24)), refusal('data', /Float32Array/));
    assert.throws(() => sky(Float32Array.from({length: 24}, (_, k) => (k === 7 ? NaN : 1))), refusal('', /texel \(2, 0\) is .*nan/i));
    assert.throws(() => sky(new Float32Array(24).fill(-1)), refusal('', /negative/));
    const moved = new Float32Array(24).fill(1);
    structuredClone(moved.buffer, {transfer: [moved.buffer]});
    assert.throws(() => sky(moved), refusal('data', /transferred/));
});

test('progress grows, and its exception stops the work', () => {
    const environment = dl.fromPixels(patch()), seen = [];
    dl.prefilter(environment, {progress: (done, stage) => seen.push([stage, done])});
    assert.ok(seen.length > 0 && seen.every(([stage, done]) => stage && done >= 0 && done <= 1));
    assert.throws(() => dl.prefilter(environment, {progress: () => { throw new Error('enough'); }}), /^Error: enough$/);
    const controller = new AbortController();
    assert.throws(() => dl.prefilter(environment, {signal: controller.signal, progress: () => controller.abort()}), {name: 'AbortError'});
    assert.throws(() => dl.prefilter(environment, {signal: AbortSignal.abort()}), {name: 'AbortError'});
});

test('a module that cannot be loaded is one sentence', async () => {
    await assert.rejects(load({module: pathToFileURL('/nowhere/domelight.wasm')}), refusal('', /cannot be read \(ENOENT\)/));
    await assert.rejects(load({module: 'http://127.0.0.1:1/domelight.wasm'}), refusal('', /cannot be fetched/));
    await assert.rejects(load({module: new Uint8Array(100)}), refusal('', /is not a WebAssembly module/));
});

test('10 000 calls leave the memory as it was', () => {
    const pixels = {data: new Float32Array(3 * 32).fill(1), width: 8, height: 4};
    const round = k => {
        const environment = dl.fromPixels(pixels);
        environment.radiance([0, 1, 0]);
        dl.encode([{data: pixels.data, width: 8, height: 4}]);
        assert.throws(() => dl.prefilter(environment, {layout: 'nothing'}));
        if (k % 100 === 0) dl.prefilter(environment, {size: 4, levels: 2, shBands: 2});
        environment.close();
    };
    for (let k = 0; k < 200; ++k) round(k);
    const before = dl.memoryBytes;
    for (let k = 0; k < 2000; ++k) round(k);
    assert.equal(dl.memoryBytes, before);
});
