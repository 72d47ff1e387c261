// Makes every picture of the browser app and of the pages that teach in the README and in docs.
//
//     node screenshots.mjs PROGRAM CHROMIUM MODEL SUNRISE MEADOW [NAME...]      (after `./run view`, which builds the page)
//
// The committed ones: the Khronos "Flight Helmet" under Poly Haven's "Spruit Sunrise", and "Noon Grass" (all CC0), 1024 x 512. NAME: only these pictures.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {execFileSync, spawn} from 'node:child_process';
import {fileURLToPath} from 'node:url';
import {launch} from '../../../tests/engines/browser/browser.mjs';

const [program, chromium, model, sunrise, meadow, ...names] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url)), root = path.resolve(here, '../../..');
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'screenshots-'));
const run = (command, ...args) => execFileSync(command, args.map(String), {stdio: ['ignore', 'ignore', 'inherit']});
const k_patience_ms = 900_000;

/// The rooms of docs/probes.md, with probes between which there are tetrahedra.
function makeRooms() {
    const [scene, light, probes] = ['rooms.glb', 'rooms.hdr', 'probes'].map(name => path.join(work, name));
    run('/usr/bin/python3', path.join(root, 'docs/figures/probes/rooms.py'), scene);
    run(program, 'sky', '-o', light, '--quiet');
    run(program, 'probes', scene, '--env', light, '-o', probes, '--auto', 40, '--size', 16, '--spp', 16, '--quiet');
    return [scene, light, '--probes', probes];
}

const rest = page => page.waitForFunction(() => domelight.ready && domelight.app.least >= 8, undefined, {timeout: k_patience_ms});

/// Of each picture: its file, what `domelight view` is given, the page with its address, the size, and what is done on it before it is taken.
const pictures = {
    view: {
        file: '../readme/view.jpg', files: () => [model, sunrise], address: '#fullResolution=true&divider=0.37&shadows=true', size: [1200, 720],
        prepare: async page => {
            await page.getByRole('button', {name: 'Compare with the truth'}).click();
            await page.getByText(/^256 samples a pixel/).waitFor({timeout: k_patience_ms});
        },
    },
    difference: {
        files: () => [model, meadow], address: '#fullResolution=true&mode=split-sum&other=monte-carlo&view=flip', size: [1200, 720],
        prepare: async page => {
            const note = page.locator('#panel .note', {hasText: 'mean FLIP'});
            await note.waitFor({state: 'attached', timeout: k_patience_ms});
            await note.evaluate(element => {
                const details = element.closest('details');
                details.open = true;
                details.scrollIntoView();
            });
        },
    },
    probes: {files: makeRooms, address: '#fullResolution=true&probeBalls=true&eye=0.5,1.7,3.4&target=6,0.9,1&fov=65&exposure=-3.3&panel=false', size: [800, 450]},
    irradiance: {files: () => [], page: 'irradiance', address: '#environment=sunset&k=32&j=8', size: [1060, 860]},
    importance: {files: () => [], page: 'importance', address: '', size: [1060, 940]},
    mis: {files: () => [], page: 'mis', address: '', size: [1060, 780]},
};

async function take(browser, name, {file = `${name}.jpg`, files, page: lesson, address, size: [width, height], prepare}) {
    const server = spawn(program, ['view', ...files(), '--no-browser', '--app', path.join(root, 'build/web')], {stdio: ['ignore', 'pipe', 'inherit']});
    try {
        const url = await new Promise(resolve => server.stdout.once('data', data => resolve(String(data).trim())));
        const page = await browser.newPage({viewport: {width, height}, colorScheme: lesson ? 'light' : 'dark'});
        await page.goto(lesson ? `${url}learn/${lesson}/index.html${address}` : `${url}${address}`);
        if (lesson) await page.waitForFunction(() => window.lesson?.ready, undefined, {timeout: k_patience_ms});
        else await page.waitForFunction(() => window.domelight?.ready, undefined, {timeout: k_patience_ms});
        await prepare?.(page);
        if (!lesson) await rest(page);
        const to = path.join(here, file);
        await page.screenshot({path: to, type: 'jpeg', quality: 82});
        await page.close();
        console.log(`${path.relative(root, to)}: ${Math.round(fs.statSync(to).size / 1024)} KB`);
    } finally {
        server.kill('SIGTERM');
    }
}

const browser = await launch(path.join(root, 'web/node_modules'), chromium);
try {
    for (const [name, picture] of Object.entries(pictures)) if (names.length === 0 || names.includes(name)) await take(browser, name, picture);
} finally {
    await browser.close();
    fs.rmSync(work, {recursive: true});
}
