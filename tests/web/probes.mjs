// A set of probes in the app: frames beside those of `domelight render --probes`, controls, and broken sets.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {readHdr} from '../engines/browser/files.mjs';
import {displayedError, readPane, setState} from './frames.mjs';

const width = 320, height = 160, frames = 8;
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
];
const usual = ['split-sum', 'as engines do'];
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
    await dropFiles(page, ['/work/rooms.glb', '/work/rooms.hdr', ...setFiles.map(name => `/work/probes/${name}`)]);
    for (const {name, state, options} of all ? cases : cases.filter(({name}) => usual.includes(name))) {
        const file = path.join(work, `probes-${name.replaceAll(' ', '-')}.hdr`);
        domelight('render', path.join(work, 'rooms.glb'), '--env', path.join(work, 'rooms.hdr'), '--probes', path.join(work, 'probes'), '--width', width, '--height', height, '--spp', 8,
                  '--camera-position', eye.join(), '--camera-target', target.join(), '--fov-deg', fov, '--quiet', '-o', file, ...options);
        await setState(page, {...plain, eye, target, fov, ...state});
        const scaled = values => values.map(v => v * exposure), error = displayedError(scaled(await readPane(page, frames)), scaled(readHdr(file).rgb));
        claim(`probes, ${name}: the app draws what the renderer draws, within 2/255`, error <= 2 ? [] : [`the RMS error is ${error.toFixed(2)}/255`], `${error.toFixed(2)}/255`);
    }
    // The balls: white rims where a probe stands in view.
    await setState(page, {...plain, probeBalls: false});
    const without = await readPane(page, 1);
    await setState(page, {probeBalls: true});
    const changed = displayedError(without, await readPane(page, 1));
    claim('probes: balls show where they stand', changed > 1 ? [] : [`the picture changes by ${changed.toFixed(2)}/255`]);
    claim('probes, frames: the console is silent', page.complaints);
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
    domelight('probes', path.join(work, 'rooms.glb'), '--env', path.join(work, 'rooms.hdr'), '-o', path.join(work, 'probes'), '--grid', '6,2,3', '--size', 16, '--spp', 8, '--bounces', 3, '--quiet');
    const more = {...app, domelight};
    await testProbeFrames(more);
    await testProbePage(more);
}
