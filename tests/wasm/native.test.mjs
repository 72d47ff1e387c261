// The module beside the program: the same photograph gives the same levels; its size, and the time that it takes.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {test} from 'node:test';
import zlib from 'node:zlib';
import {load} from 'domelight/library';
import {readKtx2, relativeRms} from './ktx2.mjs';
import {readHdr} from './radiance.mjs';

const program = process.env.DOMELIGHT_PROGRAM, data = process.env.DOMELIGHT_DATA;
const photographs = ['noon_grass', 'blocky_photo_studio', 'dikhololo_night', 'leadenhall_market', 'kloppenheim_05'];
const without = !program || !fs.existsSync(program) ? 'the program has not been built' : !data ? 'DOMELIGHT_DATA names no folder' : false;

test('the module is at most 300 KB gzipped, and the one with the readers of all formats 500 KB', () => {
    const size = file => zlib.gzipSync(fs.readFileSync(file), {level: 9}).length;
    const small = size(process.env.DOMELIGHT_MODULE), files = size(process.env.DOMELIGHT_MODULE.replace('.wasm', '-files.wasm'));
    assert.ok(small <= 300_000 && files <= 500_000, `they are ${small} and ${files} bytes`);
});

const cpu = run => {
    const before = process.cpuUsage();
    const result = run(), {user, system} = process.cpuUsage(before);
    return {result, ms: (user + system) / 1000};
};

test('levels, relative to those of the program, within 1e-6 RMS', {skip: without}, async context => {
    const dl = await load(), work = fs.mkdtempSync(path.join(os.tmpdir(), 'domelight-'));
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
    fs.rmSync(work, {recursive: true});
});

test('a live probe, six faces of 64², is baked in 5 levels', async context => {
    const dl = await load();
    for (const size of [64, 32]) {
        const data = Uint16Array.from({length: 6 * size * size * 4}, (_, k) => 0x3000 + (k * 2654435761 % 4096));
        const bake = () => {
            const environment = dl.fromPixels({data, width: size, height: size, faces: 6, channels: 4});
            const baked = dl.bake(environment, {engine: 'khronos', size, levels: 5, texels: 'centre'});
            environment.close();
            return baked;
        };
        for (let k = 0; k < 5; ++k) bake();
        const times = Array.from({length: 15}, () => cpu(bake).ms).sort((a, b) => a - b);
        context.diagnostic(`${size}²: median ${times[7].toFixed(1)} ms of CPU, worst ${times[14].toFixed(1)}`);
        assert.equal(bake().levels.length, 5);
    }
});
