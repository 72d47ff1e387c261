// The page of `domelight view`: the path tracer's picture beside a method and in its place.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync, spawn} from 'node:child_process';
import {displayedError, readPane, setState} from './frames.mjs';
import {texturedModel} from './textured_model.mjs';

const width = 720, height = 160;

/// `domelight view` of files in a folder; {url, end()}.
async function view(program, app, folder, ...files) {
    const child = spawn(path.resolve(program), ['view', '--no-browser', '--app', app, ...files], {cwd: folder, stdio: ['ignore', 'pipe', 'ignore']});
    const url = await new Promise((resolve, reject) => {
        child.stdout.once('data', data => resolve(String(data).trim()));
        child.once('exit', code => reject(new Error(`domelight view ended with ${code}`)));
    });
    return {url, end: () => new Promise(done => child.once('exit', done) && child.kill('SIGINT'))};
}

export async function testTruth({program, root, work, browser, watch, claim}) {
    execFileSync(program, ['sky', '-o', path.join(work, 'truth-sky.hdr'), '--height', '128', '--no-sun-disc', '--quiet']);
    fs.writeFileSync(path.join(work, 'textured.glb'), texturedModel());
    const served = await view(program, path.join(root, 'build/web'), work, 'textured.glb', 'truth-sky.hdr');
    const page = watch(await browser.newPage({viewport: {width, height}}));
    try {
        await page.goto(`${served.url}#exposure=-5&mode=monte-carlo&samples=4&fullResolution=true&lights=false&truthSamples=6&eye=1.5,1,4&fov=34`);
        await page.waitForFunction(() => window.domelight?.ready && domelight.app.model.name === 'textured.glb', undefined, {timeout: 30_000});
        const state = key => page.evaluate(key => domelight.store.state[key], key), seen = [];
        for (let k = 0; k < 3; ++k) {
            await page.keyboard.press('t');
            await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
            seen.push(await state('view'));
        }
        claim('truth: T puts it beside the method, then in its place, then takes it away', String(seen) === 'split,other,one' ? [] : [String(seen)]);
        await setState(page, {view: 'other', other: 'truth'});
        await page.waitForFunction(() => /· 64 samples/.test([...document.querySelectorAll('#view .tag')].at(-1).textContent), undefined, {timeout: 60_000});
        const truth = await page.evaluate(() => {
            const {width, height, data} = domelight.stage.pictures.truth.image, rgb = [];
            for (let y = height - 1; y >= 0; --y) for (let x = 0; x < width; ++x) rgb.push(...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3));
            return {width, height, rgb};
        });
        claim('truth: it fills the whole pane, also below the panel', truth.width === width && truth.height === height ? [] : [`${truth.width} x ${truth.height}`]);
        const shown = v => v / 32, error = displayedError((await readPane(page, 16)).map(shown), truth.rgb.map(shown));
        claim('truth: it shows the scene where the page draws it, in the same light, within 3/255', error < 3 ? [] : [`the RMS error is ${error.toFixed(2)}/255`], `${error.toFixed(2)}/255`);
        await page.mouse.move(300, 80);
        await page.waitForFunction(() => document.querySelector('#status span:nth-child(2) b'), undefined, {timeout: 10_000});
        const under = await page.textContent('#status span:nth-child(2) b'), expected = truth.rgb.slice(3 * (80 * width + 300), 3 * (80 * width + 300) + 3).map(v => v.toPrecision(3)).join('  ');
        claim('truth: the pixel under the pointer is one of it', under === expected ? [] : [`${under}, not ${expected}`]);
        await setState(page, {turn: 30});
        const waiting = await page.evaluate(() => [...document.querySelectorAll('#view .tag')].at(-1).textContent);
        claim('truth: an earlier picture is not shown when the view has changed', /on its way/.test(waiting) ? [] : [waiting]);
        claim('truth: the console is silent', page.complaints);
    } finally {
        await page.close();
        await served.end();
    }
}
