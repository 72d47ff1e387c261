// A set of probes in the app: frames beside those of `domelight render --probes`, controls, and broken sets.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {readHdr} from '../engines/browser/files.mjs';
import {displayedError, readPane, setState} from './frames.mjs';

const width = 320, height = 160;
/// The rooms are bright: as a camera would expose them.
const exposure = 0.1;
const eye = [0.5, 1.7, 3.4], target = [6, 0.9, 1], fov = 65;
const plain = {mode: 'split-sum', probes: true, irradiance: 'cube', probeBlend: 8, probeParallax: true, probeVisibility: true};
const cases = [
    {name: 'split-sum', state: {}, options: ['--shading', 'split-sum']},
    {name: 'as engines do', state: {irradiance: 'sh', probeBlend: 2, probeParallax: false, probeVisibility: false},
     options: ['--shading', 'split-sum', '--irradiance', 'sh', '--probe-blend', 2, '--parallax', 'off', '--probe-visibility', 'off']},
    {name: 'phong', state: {mode: 'phong'}, options: ['--shading', 'phong']},
    {name: 'stretched', state: {mode: 'stretched'}, options: ['--shading', 'stretched']},
    // Places that are no grid: tetrahedra, of the valid probes or of all of them.
    {name: 'tetrahedra', set: 'scattered', state: {}, options: ['--shading', 'split-sum']},
    {name: 'tetrahedra on a plane', set: 'plane', state: {}, options: ['--shading', 'split-sum']},
    {name: 'tetrahedra in the middle of a room', set: 'few', samples: 24, state: {}, options: ['--shading', 'split-sum']},
    {name: 'tetrahedra without visibility', set: 'few', samples: 24, state: {probeVisibility: false, probeParallax: false}, options: ['--shading', 'split-sum', '--probe-visibility', 'off', '--parallax', 'off']},
];
const usual = ['split-sum', 'as engines do', 'tetrahedra'];
const setFiles = ['probes.json', 'specular.ktx2', 'irradiance.ktx2', 'distance.ktx2'];

/// Gives the app files by their addresses, as if they had been dropped. changed: the text of some of them.
const dropFiles = (page, addresses, changed = {}) => page.evaluate(async ([addresses, changed]) => {
    const files = await Promise.all(addresses.map(async url => {
        const name = url.split('/').at(-1);
        return new File([changed[name] ?? await (await fetch(url)).arrayBuffer()], name);
    }));
    await domelight.openFiles(files);
}, [addresses, changed]);

const notes = page => page.evaluate(() => {
    const text = document.querySelector('#notes').innerText;
    for (const close of document.querySelectorAll('#notes button')) close.click();
    return text;
});

async function testProbeFrames({all, domelight, open, work, claim}) {
    const page = await open('#size=64&panel=false&fullResolution=true', {viewport: {width, height}});
    await dropFiles(page, ['/work/rooms.glb', '/work/rooms.hdr']);
    let opened;
    const openSet = async set => set === opened || dropFiles(page, setFiles.map(name => `/work/${(opened = set)}/${name}`));
    for (const {name, set = 'probes', samples = 8, state, options} of all ? cases : cases.filter(({name}) => usual.includes(name))) {
        const file = path.join(work, `probes-${name.replaceAll(' ', '-')}.hdr`);
        await openSet(set);
        domelight('render', path.join(work, 'rooms.glb'), '--env', path.join(work, 'rooms.hdr'), '--probes', path.join(work, set), '--width', width, '--height', height, '--spp', samples,
                  '--camera-position', eye.join(), '--camera-target', target.join(), '--fov-deg', fov, '--quiet', '-o', file, ...options);
        await setState(page, {...plain, eye, target, fov, ...state});
        const scaled = values => values.map(v => v * exposure), error = displayedError(scaled(await readPane(page, samples)), scaled(readHdr(file).rgb));
        claim(`probes, ${name}: the app draws what the renderer draws, within 2/255`, error <= 2 ? [] : [`the RMS error is ${error.toFixed(2)}/255`], `${error.toFixed(2)}/255`);
    }
    // The balls: white rims where a probe stands in view.
    await openSet('probes');
    await setState(page, {...plain, probeBalls: false});
    const without = await readPane(page, 1);
    await setState(page, {probeBalls: true});
    const changed = displayedError(without, await readPane(page, 1));
    claim('probes: balls show where they stand', changed > 1 ? [] : [`the picture changes by ${changed.toFixed(2)}/255`]);
    claim('probes, frames: the console is silent', page.complaints);
    await page.close();
}

/// A folder is dropped from the desktop: the browser gives its files to the page one level after the other.
async function testDroppedFolder({open, work, claim}) {
    const page = await open('', {viewport: {width: 640, height: 400}}), devtools = await page.context().newCDPSession(page);
    const drop = async file => {
        for (const type of ['dragEnter', 'dragOver', 'drop']) await devtools.send('Input.dispatchDragEvent', {type, x: 200, y: 200, data: {items: [], files: [file], dragOperationsMask: 1}});
    };
    // In a folder of its own, with files that are none of the set's.
    const folder = path.join(work, 'dropped');
    fs.mkdirSync(path.join(folder, 'set'), {recursive: true});
    for (const name of setFiles) fs.copyFileSync(path.join(work, 'probes', name), path.join(folder, 'set', name));
    fs.writeFileSync(path.join(folder, 'set', 'notes.txt'), 'Captured in November.');
    await drop(folder);
    const count = await page.waitForFunction(() => domelight.stage.probes.set?.record.probes.length, undefined, {timeout: 20_000}).then(handle => handle.jsonValue(), () => 0);
    claim('probes: a dropped folder is read with the folders in it', count === 36 ? [] : [`the set has ${count} probes`]);
    await drop(path.join(work, 'rooms.glb'));
    await page.waitForFunction(() => domelight.app.model.name === 'rooms.glb', undefined, {timeout: 20_000}).catch(() => {});
    claim('probes: a dropped file opens too, and the sign goes away', (await page.evaluate(() => domelight.app.model.name)) === 'rooms.glb' && !(await page.locator('#drop').isVisible()) ? [] : [(await notes(page)) || 'it is not open']);
    await page.close();
}

async function testProbePage({open, work, root, claim}) {
    const record = fs.readFileSync(path.join(work, 'probes/probes.json'), 'utf8'), all = setFiles.map(name => `/work/probes/${name}`);
    const page = await open('#probeBlend=3&probeParallax=false', {viewport: {width: 390, height: 700}});
    const broken = [
        ['not JSON', all, {'probes.json': '{"format"'}, /JSON/],
        ['a missing file', all.slice(0, 2), {}, /irradiance\.ktx2, which is missing/],
        ['a grid that does not fit', all, {'probes.json': record.replace(/"counts": \[\s*6/, '"counts": [7')}, /grid\.counts.*36 probes/],
        ['a map of another kind', all, {'irradiance.ktx2': 'no texture'}, /irradiance\.ktx2: it is no KTX2 file/],
        ['a size that is not the file\'s', all, {'probes.json': JSON.stringify({...JSON.parse(record), specular: {...JSON.parse(record).specular, size: 32}})}, /but probes\.json says/],
    ];
    for (const [what, files, changed, sentence] of broken) {
        await dropFiles(page, files, changed);
        const said = await notes(page), lit = await page.evaluate(() => domelight.stage.probes.set !== null);
        claim(`probes: ${what} gives a sentence`, sentence.test(said) && !lit ? [] : [said || 'nothing is said']);
    }
    await dropFiles(page, all);
    const {blend, parallax} = await page.evaluate(() => ({blend: domelight.stage.uniforms.u_probe_most.value, parallax: domelight.stage.uniforms.u_probe_parallax.value}));
    await page.waitForFunction(() => domelight.ready);
    claim('probes: the address says how they are read', blend === 3 && parallax === false ? [] : [`${blend} blended, parallax ${parallax}`]);
    for (const [key, name, value] of [['i', 'probes', false], ['g', 'probeBalls', true]]) {
        await page.keyboard.press(key);
        claim(`keys: ${key} changes ${name}`, await page.evaluate(name => domelight.store.state[name], name) === value ? [] : ['it does not']);
    }
    await page.keyboard.press('t');
    claim('keys: T says that the truth needs the program', /domelight view/.test(await notes(page)) ? [] : ['it does not']);
    await setState(page, {panel: true, probes: true});
    await page.locator('summary', {hasText: 'Probes'}).scrollIntoViewIfNeeded();
    await page.evaluate(fs.readFileSync(path.join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8'));
    const found = await page.evaluate(() => axe.run(document, {resultTypes: ['violations']}));
    claim('probes: axe-core finds nothing', found.violations.map(v => `${v.id}: ${v.nodes.map(n => n.target).slice(0, 3).join(' ')}`));
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    claim('probes: a phone is wide enough', wide <= 0 ? [] : [`${wide} pixels are missing`]);
    await page.screenshot({path: path.join(work, 'probes-phone.png')});
    claim('probes: the console is silent', page.complaints);
    await page.close();
}

export async function testProbes(app) {
    const {program, root, work} = app, domelight = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe']});
    execFileSync('python3', [path.join(root, 'docs/figures/probes/rooms.py'), path.join(work, 'rooms.glb')]);
    domelight('sky', '-o', path.join(work, 'rooms.hdr'), '--quiet');
    const capture = (name, ...places) => domelight('probes', path.join(work, 'rooms.glb'), '--env', path.join(work, 'rooms.hdr'), '-o', path.join(work, name), ...places, '--size', 16, '--spp', 8, '--bounces', 3, '--quiet');
    capture('probes', '--grid', '6,2,3');
    capture('scattered', '--auto', 60);
    const at = (...places) => places.flatMap(place => ['--at', place]);
    if (app.all) {
        capture('plane', ...at('1,1.3,1', '2.2,1.3,2.8', '2.6,1.3,0.9', '4,1.3,1.2', '6,1.3,3', '5.8,1.3,0.8'));
        // All walls lie outside of their hull; the last one stands in the wall between the rooms, and is not valid.
        capture('few', ...at('2,1,2', '2.6,1.2,1.8', '2.2,1.8,2.4', '1.8,1.3,1.5', '2.4,1.5,2.2', '5.1,1.3,3'), '--farthest', 0);
    }
    const more = {...app, domelight};
    for (const test of [testProbeFrames, testDroppedFolder, testProbePage]) {
        const start = performance.now();
        await test(more);
        console.log(`${test.name}: ${((performance.now() - start) / 1000).toFixed(1)} s`);
    }
}
