// Makes the README's picture of the page: a model under a photograph, the split sum beside the path tracer's picture.
//
//     node view.mjs PROGRAM CHROMIUM SCENE ENVIRONMENT      (after `./run view`, which builds the page)
//
// The committed one: the Khronos "Flight Helmet" under Poly Haven's "Spruit Sunrise" (both CC0), 1024 x 512.

import {spawn} from 'node:child_process';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {launch} from '../../../tests/engines/browser/browser.mjs';

const [program, chromium, scene, environment] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url)), root = path.resolve(here, '../../..');
const server = spawn(program, ['view', scene, environment, '--no-browser', '--app', path.join(root, 'build/web')], {stdio: ['ignore', 'pipe', 'inherit']});
const url = await new Promise(resolve => server.stdout.once('data', data => resolve(String(data).trim())));
const browser = await launch(path.join(root, 'web/node_modules'), chromium);
try {
    const page = await browser.newPage({viewport: {width: 1200, height: 720}});
    await page.goto(`${url}#fullResolution=true&divider=0.37&shadows=true`);
    await page.waitForFunction(() => window.domelight?.ready, undefined, {timeout: 120_000});
    await page.getByRole('button', {name: 'Compare with the truth'}).click();
    await page.getByText(/^256 samples a pixel/).waitFor({timeout: 180_000});
    await page.waitForTimeout(20_000);
    await page.screenshot({path: path.join(here, 'view.jpg'), type: 'jpeg', quality: 88});
} finally {
    await browser.close();
    server.kill('SIGTERM');
}
