// Files that the module reads, against what the program reads of them.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, test} from 'node:test';
import * as domelight from 'domelight';
import {readKtx2, relativeRms} from './ktx2.mjs';
import {data, photograph, program, temporaryFolder, without} from './program.mjs';
import {readHdr} from './radiance.mjs';

const work = temporaryFolder();
after(() => domelight.terminate());

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

/// Two levels of the file, by the program and by the module.
async function filtersAlike(file) {
    const folder = path.join(work, `${path.basename(file)}_levels`);
    execFileSync(program, ['bake', file, '-o', folder, '--layout', 'cube', '--size', '32', '--levels', '2', '--roughness', '0,0.5', '--texels', 'centre',
                           '--encoding', 'rgba32f', '--quiet', '--no-preview'], {stdio: 'ignore'});
    const expected = readKtx2(path.join(folder, 'specular.ktx2')), environment = await domelight.read(file);
    const {levels} = await domelight.prefilter(environment, {levels: [{size: 32, roughness: 0}, {size: 16, roughness: 0.5}]});
    levels.forEach(({data}, l) => assert.ok(relativeRms(data, expected[l].data) <= 1e-6, `${file}, level ${l}: ${relativeRms(data, expected[l].data)}`));
    environment.close();
}

test('PNG of 8 bits, JPEG, and cubes in KTX2, KTX, DDS and .env: the light that the program reads', {skip: without}, async () => {
    const convert = (name, ...options) => {
        const file = path.join(work, name);
        execFileSync(program, ['convert', photograph, '-o', file, '--quiet', ...options], {stdio: 'ignore'});
        return file;
    };
    const files = [convert('small.png', '--size', '64'), convert('small.jpg', '--size', '64')];
    for (const [format, engine, ...options] of [['ktx2', 'generic', '--encoding', 'rgb9e5'], ['ktx2', 'generic', '--encoding', 'uastc-hdr'], ['ktx2', 'generic', '--encoding', 'bc6h'],
                                                ['ktx', 'filament'], ['dds', 'generic', '--format', 'dds'], ['env', 'babylon']]) {
        const folder = path.join(work, `${engine}_${options.join('')}`);
        execFileSync(program, ['bake', photograph, '-o', folder, '--for', engine, '--size', '64', '--quiet', '--no-preview', ...options], {stdio: 'ignore'});
        files.push(path.join(folder, fs.readdirSync(folder).find(name => name.endsWith(`.${format}`) && !/brdf|irradiance/.test(name))));
    }
    for (const file of files) await filtersAlike(file);
});

test('files of other programs: the light that the program reads', {skip: without}, async () => {
    for (const file of ['reference/symmetrical_garden/symmetrical_garden.env', 'reference/filament_default_env/default_env_skybox.ktx', 'env_projections/dxt1-cube-mips.dds',
                        'env_projections/KernerEnvCube.exr', 'env_highres/spruit_sunrise_4k.jpg'])
        if (fs.existsSync(path.join(data, file))) await filtersAlike(path.join(data, file));
});

test('damaged PNG, JPEG, KTX2 and .env: one sentence, and the next file is read', {skip: without}, async () => {
    const {read} = await import('domelight/library').then(({load}) => load({module: fs.readFileSync(process.env.DOMELIGHT_MODULE.replace('.wasm', '-files.wasm'))})).then(library => ({read: library.read.bind(library)}));
    for (const file of ['small.png', 'small.jpg', 'generic_--encodingrgb9e5/specular.ktx2', 'babylon_/environment.env']) {
        const name = path.join(work, file);
        if (!fs.existsSync(name)) continue;
        const whole = fs.readFileSync(name);
        for (let k = 1; k < 40; ++k) {
            const damaged = Buffer.from(whole.subarray(0, k % 2 ? whole.length : Math.floor(whole.length * k / 40)));
            for (let i = 0; i < 4; ++i) damaged[(k * 7919 + i * 104729) % damaged.length] ^= 1 << (k % 8);
            try {
                read(damaged, {name: file}).close();
            } catch (error) {
                assert.equal(error.name, 'DomelightError');
                assert.doesNotMatch(error.message, /module ended/);
            }
        }
        read(whole).close();
    }
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
    await assert.rejects(domelight.read(Buffer.from('glTF\x02\0\0\0', 'latin1')), {name: 'DomelightError'});
});
