// Frames of the app beside those of `domelight render`: the same scene, camera and light.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {readHdr} from '../engines/browser/files.mjs';
import {texturedModel} from './textured_model.mjs';

const width = 320, height = 160, size = 256, frames = 32;
const cases = [
    {name: 'split-sum', state: {mode: 'split-sum'}, options: ['--shading', 'split-sum']},
    {name: 'split-sum-more', state: {mode: 'split-sum', irradiance: 'sh', multipleScattering: true, bentLookup: true},
     options: ['--shading', 'split-sum', '--irradiance', 'sh', '--multiple-scattering', '--bent-lookup']},
    {name: 'stretched', state: {mode: 'stretched'}, options: ['--shading', 'stretched']},
    {name: 'phong', state: {mode: 'phong'}, options: ['--shading', 'phong'], lobe: 'phong'},
    {name: 'mirror', state: {mode: 'mirror', lookup: 'environment'}, options: ['--shading', 'mirror']},
    ...['mirror', 'refract'].flatMap(mode => ['cube', 'latlong', 'sphere-map', 'dual-paraboloid'].map(lookup => ({
        name: `${mode}-${lookup}`, state: {mode, lookup, lookupSize: 256}, options: ['--shading', mode, '--lookup', lookup, '--lookup-size', 256],
    }))),
];

// Every method by both models, and every texture of reflection mapping by one of them.
const usual = ['split-sum', 'stretched', 'phong', 'mirror', 'refract-cube'], usualTextured = ['split-sum', 'stretched', 'phong', 'mirror-dual-paraboloid', 'mirror-latlong', 'refract-sphere-map'];

/// The mean of a pane's first frames: RGB floats, rows from the top.
export async function readPane(page, frames, pane = 0) {
    const base64 = await page.evaluate(([n, p]) => domelight.paneAt(n, p), [frames, pane]);
    const bytes = Buffer.from(base64, 'base64');
    return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}

const encode = v => {
    const c = Math.min(1, Math.max(0, v));
    return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
};

/// Root mean square of the difference in the values of a display, of 255.
export function displayedError(a, b) {
    let sum = 0;
    for (let k = 0; k < a.length; ++k) sum += (encode(a[k]) - encode(b[k])) ** 2;
    return 255 * Math.sqrt(sum / a.length);
}

/// Changes what the user can choose, and waits until everything for it has been computed.
export async function setState(page, changes) {
    await page.evaluate(changes => domelight.store.set(changes), changes);
    await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
    await page.waitForFunction(() => domelight.ready, undefined, {timeout: 30_000});
}

/// Gives the app a file as if it had been dropped, and waits until it is lit.
export async function openFile(page, url, name) {
    await page.evaluate(async ([url, name]) => {
        const bytes = await (await fetch(url)).arrayBuffer();
        await domelight.openFiles([new File([bytes], name)]);
    }, [url, name]);
}

export async function testFrames({all, program, work, open, claim, data}) {
    const domelight = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe']});
    const environment = path.join(work, 'sky.hdr');
    if (data) fs.copyFileSync(path.join(data, 'env_latlong/noon_grass_1k.hdr'), environment);
    else domelight('sky', '-o', environment, '--quiet');
    for (const lobe of ['ggx', 'phong'])
        domelight('bake', environment, '-o', path.join(work, lobe), '--size', size, '--lobe', lobe, '--quiet', '--no-preview');
    fs.writeFileSync(path.join(work, 'textured.glb'), texturedModel());
    const page = await open(`#size=${size}&panel=false&fullResolution=true`, {viewport: {width, height}});
    await openFile(page, '/work/sky.hdr', 'sky.hdr');
    const compare = async (scene, {name, state, options, lobe = 'ggx'}, camera = []) => {
        const file = path.join(work, `${name}.hdr`), maps = /mirror|refract/.test(name) ? [] : ['--maps', path.join(work, lobe)];
        domelight('render', scene, '--env', environment, ...maps, '--width', width, '--height', height, '--spp', 32, '--quiet', '-o', file, ...options, ...camera);
        await setState(page, {irradiance: 'cube', multipleScattering: false, bentLookup: false, ...state});
        const error = displayedError(await readPane(page, frames), readHdr(file).rgb);
        claim(`${name}: the app draws what the renderer draws, within 2/255`, error <= 2 ? [] : [`the RMS error is ${error.toFixed(2)}/255`], `${error.toFixed(2)}/255`);
    };
    const chosen = names => (all ? cases : cases.filter(({name}) => names.includes(name)));
    for (const one of chosen(usual)) await compare('spheres', one);
    // With textures and lights of its own.
    await openFile(page, '/work/textured.glb', 'textured.glb');
    await setState(page, {eye: [1.5, 1, 4], target: [0, 0, 0], fov: 34});
    for (const one of chosen(usualTextured))
        await compare(path.join(work, 'textured.glb'), {...one, name: `textured-${one.name}`}, ['--camera-position', '1.5,1,4', '--camera-target', '0,0,0', '--fov-deg', 34]);
    claim('all modes: the console is silent', page.complaints);
    await page.close();
}
