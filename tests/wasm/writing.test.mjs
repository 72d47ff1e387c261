// Files that the module writes, beside those of the program.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, test} from 'node:test';
import * as domelight from 'domelight';
import {load} from 'domelight/library';
import {relativeRms} from './ktx2.mjs';
import {photograph, program, temporaryFolder, without} from './program.mjs';

const work = temporaryFolder();
after(() => domelight.terminate());
const same = (bytes, file) => assert.ok(Buffer.from(bytes).equals(fs.readFileSync(file)), `${path.basename(file)} has other bytes`);
const named = files => Object.fromEntries(files.map(({name, data}) => [name, data]));

/// A small sky with a bright patch, the same in every run.
function sky(width = 64) {
    const data = Float32Array.from({length: 3 * width * width / 2}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024);
    data.fill(40, 3 * (8 * width + 20), 3 * (8 * width + 24));
    return {data, width, height: width / 2};
}

test('bakes for engines have the files of the program', {skip: without}, async context => {
    const environment = await domelight.read(photograph);
    /// The engine's options, what has the same bytes in both, and what differs in the last bits of floats.
    const engines = {
        generic: [{size: 64}, ['brdf.ktx2'], ['specular.ktx2', 'irradiance.ktx2']],
        three: [{size: 64}, [], ['noon_grass_1k.pmrem.ktx2']],
        babylon: [{size: 64}, [], ['noon_grass_1k.env']],
        filament: [{size: 64}, ['brdf.ktx2'], ['noon_grass_1k_ibl.ktx']],
        bevy: [{size: 64}, [], ['noon_grass_1k_specular.ktx2', 'noon_grass_1k_diffuse.ktx2']],
        unity: [{size: 64}, ['noon_grass_1k_latlong.exr'], ['noon_grass_1k.dds']],
        blender: [{}, ['noon_grass_1k.exr'], []],
        materialx: [{size: 64}, [], ['noon_grass_1k.exr']],
        gltf: [{size: 64}, [], []],
        playcanvas: [{}, [], []],
    };
    for (const [engine, [options, equal, near]] of Object.entries(engines)) {
        const folder = path.join(work, engine), size = options.size ? ['--size', String(options.size)] : [];
        execFileSync(program, ['bake', photograph, '-o', folder, '--for', engine, '--no-preview', '--quiet', ...size]);
        const files = named(await domelight.bakeFiles(environment, {engines: engine, preview: false, ...options}));
        assert.deepEqual(Object.keys(files).sort(), fs.readdirSync(folder, {recursive: true}).filter(name => fs.statSync(path.join(folder, name)).isFile()).sort(), engine);
        for (const name of equal) same(files[name], path.join(folder, name));
        for (const name of near) {
            const ours = await domelight.read(files[name], {name}), theirs = await domelight.read(path.join(folder, name));
            const off = relativeRms((await ours.latlong()).data, (await theirs.latlong()).data);
            context.diagnostic(`${engine}: ${name}: relative RMS ${off.toExponential(1)}`);
            assert.ok(off <= 2e-3, `${name}: ${off}`);
            ours.close();
            theirs.close();
        }
        const manifest = JSON.parse(Buffer.from(files['manifest.json'])), expected = JSON.parse(fs.readFileSync(path.join(folder, 'manifest.json')));
        assert.deepEqual(manifest.source, {...expected.source, mean_radiance: manifest.source.mean_radiance}, 'the hash of the source, among others');
    }
    environment.close();
});

test('pictures have the bytes of domelight convert', {skip: without}, async () => {
    const environment = await domelight.read(photograph), hdr = path.join(work, 'picture.hdr'), exr = path.join(work, 'picture.exr');
    execFileSync(program, ['convert', photograph, '-o', hdr, '--quiet']);
    execFileSync(program, ['convert', photograph, '-o', exr, '--quiet']);
    same(await domelight.write(environment, {format: 'hdr'}), hdr);
    const ours = await domelight.read(await domelight.write(environment, {format: 'exr'})), theirs = await domelight.read(exr);
    assert.deepEqual((await ours.latlong()).data, (await theirs.latlong()).data);
    environment.close();
});

test('textures are read back from every container', async () => {
    const environment = await domelight.fromPixels(sky());
    const texture = await domelight.bake(environment, {engine: 'khronos', size: 32});
    const expected = await domelight.prefilter(environment, {levels: [{size: 32, roughness: 0}]});
    for (const format of ['ktx2', 'ktx1', 'dds', 'dds9']) {
        const bytes = await domelight.write(texture, {format, metadata: {'example.note': 'of a test'}}), back = await domelight.read(bytes);
        assert.ok(Buffer.from(bytes).includes('of a test') === format.startsWith('ktx'), format);
        assert.equal(back.projection, 'cube');
        const {levels: [cube]} = await domelight.prefilter(back, {levels: [{size: 32, roughness: 0}]});
        assert.ok(relativeRms(cube.data, expected.levels[0].data) < 5e-4, format);
        back.close();
    }
    const packed = await domelight.write(texture, {supercompression: 'zstd'});
    assert.ok(packed.length < (await domelight.write(texture)).length);
    // Levels of floats are encoded on the way.
    const {levels} = await domelight.prefilter(environment, {size: 32, levels: 2, texels: 'centre'});
    assert.deepEqual(await domelight.write(levels), await domelight.write(await domelight.encode(levels)));
    environment.close();
});

test('a .env file is the same of a mirrored bake as of one that is not', async () => {
    const environment = await domelight.fromPixels(sky());
    const bake = mirror => domelight.bake(environment, {engine: 'babylon', size: 16, encoding: 'rgbd', shBands: 3, mirror});
    const files = await Promise.all([true, false].map(async mirror => domelight.write(await bake(mirror), {format: 'env'})));
    const polynomials = files.map(file => JSON.parse(Buffer.from(file.subarray(8, file.indexOf(0, 8)))).irradiance);
    for (const term of Object.keys(polynomials[0]))
        polynomials[0][term].forEach((v, c) => assert.ok(Math.abs(v - polynomials[1][term][c]) < 1e-4, `${term}: ${v} ${polynomials[1][term][c]}`));
    const [a, b] = await Promise.all(files.map(async file => (await domelight.read(file)).latlong()));
    assert.ok(relativeRms(a.data, b.data) < 0.02);
    const {levels: [expected]} = await domelight.prefilter(environment, {levels: [{size: 16, roughness: 0}]});
    const {levels: [cube]} = await domelight.prefilter(await domelight.read(files[0]), {levels: [{size: 16, roughness: 0}]});
    assert.ok(relativeRms(cube.data, expected.data) < 0.02, 'the light is where it was');
    environment.close();
});

test('what cannot be written is one sentence', async () => {
    const environment = await domelight.fromPixels(sky()), texture = await domelight.bake(environment, {size: 16});
    await assert.rejects(domelight.write(texture, {format: 'tiff'}), {field: 'format'});
    await assert.rejects(domelight.write(texture, {format: 'env'}), /a \.env file holds rgbd, not rgba16f/);
    await assert.rejects(domelight.write(texture, {format: 'exr'}), /format: exr holds pixels of floats, not encoded texels/);
    await assert.rejects(domelight.write([sky(), sky(32)], {format: 'hdr'}), /hdr holds one picture, not 2 levels/);
    await assert.rejects(domelight.write(texture, {encoding: 'bc6h'}), {field: 'encoding'});
    await assert.rejects(domelight.write(texture, {form: 'ktx2'}), /form: is not an option/);
    await assert.rejects(domelight.write({...texture, width: 64}), /level 0 has \d+ bytes, not/);
    await assert.rejects(domelight.write(undefined), /neither pixels nor a texture/);
    await assert.rejects(domelight.write(12), /neither pixels nor a texture/);
    await assert.rejects(domelight.bakeFiles(environment, {engines: 'doom'}), {field: 'engines'});
    await assert.rejects(domelight.bakeFiles(environment, {encoding: 'astc4x4-hdr'}), /astc4x4-hdr is not in the WebAssembly module/);
    await assert.rejects(domelight.bakeFiles(environment, {sizes: 4}), /sizes: is not an option/);
    await assert.rejects(domelight.bakeFiles(environment, {progress: () => { throw new Error('enough'); }}), /enough/);
    await assert.rejects(domelight.bakeFiles(environment, {signal: AbortSignal.abort()}), {name: 'AbortError'});
    await assert.rejects(domelight.bakeFiles(undefined), /not an environment/);
    environment.close();
});

test('a thousand files, and a hundred that fail, leave the memory as it was', async () => {
    const dl = await load({module: new URL('./domelight-bake.wasm', import.meta.resolve('domelight'))}), pixels = sky(16);
    const environment = dl.fromPixels(pixels), texture = dl.bake(environment, {engine: 'babylon', size: 8, encoding: 'rgbd', shBands: 3});
    const round = () => {
        for (const format of ['ktx2', 'ktx1', 'dds', 'env']) dl.write(texture, {format});
        for (const format of ['exr', 'hdr']) dl.write(pixels, {format});
        assert.throws(() => dl.write(texture, {format: 'tiff'}));
    };
    const bake = () => dl.bakeFiles(environment, {engines: 'bevy', size: 16, preview: false});
    for (let k = 0; k < 20; ++k) round();
    for (let k = 0; k < 3; ++k) bake();
    const before = dl.memoryBytes;
    for (let k = 0; k < 170; ++k) round();
    for (let k = 0; k < 10; ++k) bake();
    assert.equal(dl.memoryBytes, before);
});
