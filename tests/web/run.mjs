// The browser app, as it is built, in headless Chromium. Called by run_web.sh.
//
//   node run.mjs PROGRAM CHROMIUM [--all] [NAME...]

import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {launch, serve, webGpu} from '../engines/browser/browser.mjs';
import {testFrames} from './frames.mjs';
import {testHdr} from './hdr.mjs';
import {testInterface} from './interface.mjs';
import {testLearn} from './learn.mjs';
import {testMonteCarlo} from './monte_carlo.mjs';
import {testOverlays} from './overlays.mjs';
import {testProbes} from './probes.mjs';
import {testTruth} from './truth.mjs';
import {Claims} from '../engines/browser/claims.mjs';

const [program, chromium, ...options] = process.argv.slice(2);
const all = options.includes('--all'), names = options.filter(name => name !== '--all');
const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const work = path.join(root, 'build/web-test');
fs.mkdirSync(work, {recursive: true});

const claims = new Claims(), {claim, skip} = claims;

// What `domelight view` sends too: nothing but the app's own files may be loaded or run.
const policy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; " +
               "connect-src 'self' blob:; worker-src 'self' blob:; base-uri 'none'; form-action 'none'";
// A server without files on its command line: the page asks for its session.
fs.mkdirSync(path.join(work, 'api'), {recursive: true});
fs.writeFileSync(path.join(work, 'api/session'), JSON.stringify({scene: null, environment: [], probes: [], truth: false}));
const server = await serve({'/app/api/': path.join(work, 'api'), '/app/': path.join(root, 'build/web'), '/work/': work, '/models/': path.join(root, 'tests/web/models'), '/data/': process.env.DOMELIGHT_DATA ?? work},
                           {'Content-Security-Policy': policy});
const browser = await launch(path.join(root, 'web/node_modules'), chromium);

/// Collects what the console says of a page, other than the time that something took, in page.complaints.
function watch(page) {
    page.complaints = [];
    const complain = text => page.complaints.length < 5 && !page.complaints.includes(text) && page.complaints.push(text.slice(0, 2000));
    page.on('console', message => ['error', 'warning'].includes(message.type()) && complain(message.text()));
    page.on('pageerror', error => complain(error.stack ?? String(error)));
    return page;
}

/// Opens the app. `hash`: its state. prepare: is run in the page before anything else.
async function open(hash = '', options = {}, prepare = () => {}, inBrowser = browser) {
    const page = watch(await inBrowser.newPage({viewport: {width: 640, height: 360}, ...options}));
    await page.addInitScript(prepare);
    await page.goto(`${server.url}/app/index.html${hash}`);
    await page.waitForFunction(() => window.domelight?.ready, undefined, {timeout: 30_000});
    return page;
}

const tests = {interface: testInterface, hdr: testHdr, truth: testTruth, frames: testFrames, 'monte-carlo': testMonteCarlo, overlays: testOverlays, probes: testProbes, learn: testLearn};
const withWebGpu = () => launch(path.join(root, 'web/node_modules'), chromium, webGpu);
const app = {all, program, root, work, server, browser, withWebGpu, open, watch, claim, skip, data: process.env.DOMELIGHT_DATA};
for (const [name, test] of Object.entries(tests)) {
    if (names.length && !names.some(n => name.includes(n))) continue;
    try {
        await test(app);
    } catch (error) {
        claim(`${name} can be tested`, [error.stack ?? String(error)]);
    }
}
await browser.close();
server.close();
console.log(`web: ${claims.passed} passed, ${claims.failed} failed, ${claims.skipped} skipped`);
process.exit(claims.failed ? 1 : 0);
