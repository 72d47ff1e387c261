// The module beside the program: the same photograph gives the same levels; its size, and the time that it takes.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';
import zlib from 'node:zlib';
import {load} from 'domelight/library';
import {readKtx2, relativeRms} from './ktx2.mjs';
import {data, program, temporaryFolder, without} from './program.mjs';
import {readHdr} from './radiance.mjs';

const photographs = ['noon_grass', 'blocky_photo_studio', 'dikhololo_night', 'leadenhall_market', 'kloppenheim_05'];

test('the module is at most 258 KB gzipped, the one with the readers of all formats 475 KB, and the one that also writes files 635 KB', () => {
    for (const [name, most] of Object.entries({'.wasm': 258_000, '-files.wasm': 475_000, '-bake.wasm': 635_000})) {
        const {length} = zlib.gzipSync(fs.readFileSync(process.env.DOMELIGHT_MODULE.replace('.wasm', name)), {level: 9});
        assert.ok(length <= most, `domelight${name} has ${length} bytes`);
    }
});

const cpu = run => {
    const before = process.cpuUsage();
    const result = run(), {user, system} = process.cpuUsage(before);
    return {result, ms: (user + system) / 1000};
};

test('levels, relative to those of the program, within 1e-6 RMS', {skip: without}, async context => {
    const dl = await load(), work = temporaryFolder();
    for (const name of photographs) {
        const file = path.join(data, 'env_latlong', `${name}_1k.hdr`);
        execFileSync(program, ['bake', file, '-o', path.join(work, name), '--layout', 'cube', '--size', '256', '--levels', '5', '--roughness', '0,0.25,0.5,0.75,1',
                               '--texels', 'centre', '--encoding', 'rgba32f', '--quiet', '--no-preview']);
        const expected = readKtx2(path.join(work, name, 'specular.ktx2'));
        const environment = dl.fromPixels(readHdr(file));
        const {result} = cpu(() => dl.prefilter(environment, {size: 256, levels: 5}));
        const errors = result.levels.map(({data}, l) => relativeRms(data, expected[l].data));
        const times = Array.from({length: 5}, () => cpu(() => dl.prefilter(environment, {size: 256, levels: 5})).ms).sort((a, b) => a - b);
        context.diagnostic(`${name}: relative RMS ${errors.map(e => e.toExponential(1)).join(' ')}; ${times[2].toFixed(0)} ms of CPU`);
        for (const error of errors) assert.ok(error <= 1e-6, `${name}: ${errors}`);
        environment.close();
    }
});

test('live probes: cubes of half floats, five levels each', async context => {
    const dl = await load();
    for (const size of [64, 32]) {
        const probes = dl.probeFilter({engine: 'khronos', size, levels: 5, texels: 'centre'});
        const cube = k => ({data: Uint16Array.from({length: 6 * size * size * 4}, (_, i) => 0x3000 + ((i + k) * 2654435761 % 4096)), width: size, height: size, faces: 6, channels: 4});
        const cubes = Array.from({length: 30}, (_, k) => cube(k)), first = probes.bake(cubes[0]);
        const times = cubes.map(one => cpu(() => probes.bake(one)).ms).slice(5).sort((a, b) => a - b);
        context.diagnostic(`${size}²: median ${times[12].toFixed(1)} ms of CPU, worst ${times[24].toFixed(1)}`);
        assert.deepEqual(probes.bake(cubes[0]), first, 'a probe depends on those before it');

        const environment = dl.fromPixels(cubes[0]), once = dl.prefilter(environment, {size, levels: 5, shBands: 3});
        const levels = dl.probeFilter({engine: 'khronos', size, levels: 5, texels: 'centre', encoding: 'rgba32f'}).bake(cubes[0]).levels;
        levels.forEach(({data}, l) => assert.ok(relativeRms(new Float32Array(data.buffer).filter((_, k) => k % 4 !== 3), once.levels[l].data) <= 4e-4, `level ${l}`));
        environment.close();
        probes.close();
        assert.throws(() => probes.bake(cubes[0]), /has been closed/);
    }
    assert.throws(() => dl.probeFilter({size: 8}), /8 is not in 16 to 256/);
});
