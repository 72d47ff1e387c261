// Files that the module reads, against what the program reads of them.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {after, test} from 'node:test';
import * as domelight from 'domelight';
import {readHdr} from './radiance.mjs';

const {DOMELIGHT_PROGRAM: program, DOMELIGHT_DATA: data} = process.env;
const without = !program || !fs.existsSync(program) ? 'the program has not been built' : !data ? 'DOMELIGHT_DATA names no folder' : false;
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'domelight-'));
after(() => {
    domelight.terminate();
    fs.rmSync(work, {recursive: true});
});
const photograph = data && path.join(data, 'env_latlong/noon_grass_1k.hdr');

test('a Radiance file has the texels that are in it', {skip: without}, async () => {
    const environment = await domelight.read(photograph);
    assert.deepEqual([environment.format, environment.width, environment.height], ['Radiance HDR', 1024, 512]);
    assert.deepEqual((await environment.latlong()).data, readHdr(photograph).data);
    const {levels} = await domelight.prefilter(environment, {size: 16, levels: 2});
    assert.equal(levels[1].data.length, 6 * 8 * 8 * 3);
});

/// Compares with what the program reads, by way of a Radiance file: eight bits for each channel, and one exponent for all three.
async function agrees(exr) {
    const hdr = path.join(work, `${path.basename(exr, '.exr')}.hdr`);
    execFileSync(program, ['convert', exr, '-o', hdr, '--quiet']);
    const {data, width, height} = await (await domelight.read(exr)).latlong(), expected = readHdr(hdr);
    assert.deepEqual([width, height], [expected.width, expected.height]);
    for (let k = 0; k < data.length; k += 3) {
        const most = Math.max(...expected.data.subarray(k, k + 3));
        for (let c = 0; c < 3; ++c) assert.ok(Math.abs(data[k + c] - expected.data[k + c]) <= most / 120 + 1e-6, `texel ${k / 3}: ${data[k + c]} ${expected.data[k + c]}`);
    }
}

test('OpenEXR, zip, of half floats and of floats: the texels that the program reads', {skip: without}, async () => {
    for (const encoding of ['half', 'float']) {
        const exr = path.join(work, `${encoding}.exr`);
        execFileSync(program, ['convert', photograph, '--size', '64', '--encoding', encoding, '-o', exr, '--quiet']);
        await agrees(exr);
    }
});

test('OpenEXR, dwab: the texels that the program reads', {skip: without}, async context => {
    const dwab = fs.readdirSync(data, {recursive: true}).find(file => String(file).endsWith('_dwab.exr'));
    if (!dwab) return context.skip('no such file in DOMELIGHT_DATA');
    await agrees(path.join(data, String(dwab)));
});

test('a damaged file is one sentence', {skip: without}, async () => {
    const exr = path.join(work, 'whole.exr');
    execFileSync(program, ['convert', photograph, '--size', '64', '-o', exr, '--quiet']);
    const bytes = fs.readFileSync(exr), hdr = fs.readFileSync(photograph);
    for (const [name, cut] of [['exr', bytes.subarray(0, bytes.length / 2)], ['hdr', hdr.subarray(0, 5000)], ['nothing', Buffer.from('what?')]])
        await assert.rejects(async () => (await domelight.read(cut, {name})).latlong(), error => {
            assert.equal(error.name, 'DomelightError');
            assert.match(error.message, /\.$/);
            return true;
        });
    await assert.rejects(domelight.read(photograph, {projection: 'cubic'}), {field: 'projection'});
    await assert.rejects(domelight.read(Buffer.from('\x89PNG\r\n\x1a\n', 'latin1')), /PNG is not read by the WebAssembly module/);
});
