// How fast the browser app is, in headless Chromium without a GPU: first paint, the first lit picture after files were dropped, and the longest task of the main
// thread meanwhile. Medians, with the worst in parentheses.
//
//   node bench/web.mjs [--runs N] [--trace FILE] ENVIRONMENT [MODEL]
//   node bench/web.mjs --live [--runs N]
//
// The app is the one in build/web. --trace: a trace of the last run for Chromium's performance panel. --live: the frame rate of the moving spheres at 1280 x 720,
// all pixels, with live cubes and without them, in pairs.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {fileURLToPath} from 'node:url';
import {launch, serve} from '../tests/engines/browser/browser.mjs';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..');
const given = process.argv.slice(2), option = name => (given.includes(name) ? given.splice(given.indexOf(name), 2)[1] : undefined);
const live = given.includes('--live') && given.splice(given.indexOf('--live'), 1).length > 0;
const runs = Number(option('--runs') ?? 5), trace = option('--trace'), files = given;
if (!files.length && !live) throw new Error('Which environment? node bench/web.mjs [--runs N] [--trace FILE] ENVIRONMENT [MODEL]');

const chromium = execFileSync('sh', ['-c', 'command -v chromium'], {encoding: 'utf8'}).trim();
const folders = Object.fromEntries(files.map((file, k) => [`/file${k}/`, path.dirname(path.resolve(file))]));
const empty = fs.mkdtempSync(path.join(os.tmpdir(), 'domelight-web-'));
fs.writeFileSync(path.join(empty, 'session'), JSON.stringify({scene: null, environment: [], probes: [], truth: false}));
const server = await serve({'/app/api/': empty, '/app/': path.join(root, 'build/web'), ...folders});

const categories = ['devtools.timeline', 'v8', 'v8.execute', 'disabled-by-default-v8.cpu_profiler', 'toplevel', 'blink', 'cc', 'gpu', 'base', 'blink.user_timing'];

/// Drops the files once: milliseconds by what was measured.
async function run(browser, traced) {
    const page = await browser.newPage({viewport: {width: 1280, height: 720}});
    await page.addInitScript(() => {
        window.tasks = [];
        new PerformanceObserver(list => window.tasks.push(...list.getEntries().map(({startTime, duration}) => [startTime, duration]))).observe({type: 'longtask', buffered: true});
    });
    if (traced) await browser.startTracing(page, {path: traced, categories});
    await page.goto(`${server.url}/app/index.html`);
    await page.waitForFunction(() => window.domelight?.ready, undefined, {timeout: 60_000});
    const ready = await page.evaluate(() => performance.now());
    await page.waitForTimeout(1500);
    const measured = await page.evaluate(async names => {
        const files = await Promise.all(names.map(async ([url, name]) => new File([await (await fetch(url)).arrayBuffer()], name)));
        await new Promise(done => setTimeout(done, 300));
        window.tasks.length = 0;
        const {app} = domelight, start = performance.now(), before = app.environmentName;
        const frames = [];
        let lit = 0;
        const watch = now => {
            frames.push(now);
            if (!lit && app.environmentName !== before && app.stage.panes[0].count > 0 && files.every(({name}) => [app.environmentName, app.model.name].includes(name))) lit = now - start;
            if (!lit || now < start + lit + 1500) requestAnimationFrame(watch);
        };
        requestAnimationFrame(watch);
        await app.openFiles(files);
        const opened = performance.now() - start;
        await new Promise(done => setTimeout(done, 2500));
        const paint = performance.getEntriesByName('first-paint')[0]?.startTime ?? NaN;
        return {
            'first paint': paint, 'first lit picture': lit, 'files opened': opened, 'read the environment': app.timings.open, bake: app.timings.bake,
            'longest task': Math.max(0, ...window.tasks.map(([, duration]) => duration)), tasks: window.tasks.map(([at, d]) => `${(at - start).toFixed(0)}+${d.toFixed(0)}`).join(' '),
        };
    }, files.map((file, k) => [`/file${k}/${path.basename(file)}`, path.basename(file)]));
    if (traced) await browser.stopTracing();
    await page.close();
    return {'page ready': ready, ...measured};
}

/// Frames in a second, counted for five.
const frameRate = (page, live) => page.evaluate(async live => {
    const {stage, store} = domelight, show = stage.show.bind(stage);
    store.set({live});
    await new Promise(done => setTimeout(done, 1500));
    let frames = 0;
    stage.show = state => {
        ++frames;
        show(state);
    };
    const start = performance.now();
    await new Promise(done => setTimeout(done, 5000));
    delete stage.show;
    return (1000 * frames) / (performance.now() - start);
}, live);

if (live) {
    const browser = await launch(path.join(root, 'web/node_modules'), chromium), page = await browser.newPage({viewport: {width: 1280, height: 720}}), ratios = [];
    await page.goto(`${server.url}/app/index.html#panel=false&motion=true&fullResolution=true`);
    await page.waitForFunction(() => window.domelight?.ready, undefined, {timeout: 60_000});
    for (let k = 0; k < runs; ++k) {
        const without = await frameRate(page, false), withCubes = await frameRate(page, true);
        ratios.push(withCubes / without);
        console.log(`${without.toFixed(2)} frames/s, with live cubes ${withCubes.toFixed(2)}`);
    }
    ratios.sort((a, b) => a - b);
    console.log(`ratio ${ratios[ratios.length >> 1].toFixed(2)}  (${ratios[0].toFixed(2)})`);
    await browser.close();
}

const results = [];
for (let k = 0; k < runs && !live; ++k) {
    const browser = await launch(path.join(root, 'web/node_modules'), chromium);
    await new Promise(done => setTimeout(done, 3000));  // the browser itself has something to do first
    results.push(await run(browser, k === runs - 1 ? trace : undefined));
    await browser.close();
}
server.close();
fs.rmSync(empty, {recursive: true});
for (const key of Object.keys(results[0] ?? {})) {
    if (key === 'tasks') continue;
    const sorted = results.map(result => result[key]).sort((a, b) => a - b);
    console.log(`${key.padEnd(22)} ${sorted[sorted.length >> 1].toFixed(0).padStart(6)} ms  (${sorted.at(-1).toFixed(0)})`);
}
if (!live) console.log(`tasks of the last run above 50 ms, start + length: ${results.at(-1).tasks || 'none'}`);
