// A page that Vite has built: the worker finds what it imports, and each module its place.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';
import {app, chromium, modules, root, withoutBrowser} from './chromium.mjs';

const site = path.join(app, 'site'), without = withoutBrowser('vite');

const page = `import {bake, fromPixels, prefilter, write} from 'domelight';
window.run = async () => {
    const environment = await fromPixels({data: new Float32Array(3 * 64 * 32).fill(1), width: 64, height: 32});
    const {levels} = await prefilter(environment, {size: 16, levels: 3});
    return [levels.length, (await write(await bake(environment, {size: 16}), {format: 'ktx2'})).length];
};`;

test('a page that Vite has built filters and writes', {skip: without}, async () => {
    fs.mkdirSync(site, {recursive: true});
    fs.writeFileSync(path.join(site, 'index.html'), '<!doctype html><script type="module" src="/main.js"></script>');
    fs.writeFileSync(path.join(site, 'main.js'), page);
    const built = spawnSync(process.execPath, [path.join(modules, 'vite/bin/vite.js'), 'build'], {cwd: site, encoding: 'utf8'});
    assert.equal(built.status, 0, built.stderr);
    const {launch, serve} = await import(path.join(root, 'tests/engines/browser/browser.mjs'));
    const browser = await launch(modules, chromium), server = await serve({'/': path.join(site, 'dist')});
    try {
        const opened = await browser.newPage();
        await opened.goto(`${server.url}/index.html`);
        await opened.waitForFunction(() => window.run);
        const [levels, bytes] = await opened.evaluate(() => window.run());
        assert.equal(levels, 3);
        assert.ok(bytes > 6 * 16 * 16 * 8);
    } finally {
        await browser.close();
        server.close();
    }
});
