// A tiny web server on the loopback address, and Chromium with its GPU in software.

import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {createRequire} from 'node:module';

const types = {'.html': 'text/html', '.css': 'text/css', '.mjs': 'text/javascript', '.js': 'text/javascript', '.json': 'application/json', '.wasm': 'application/wasm', '.svg': 'image/svg+xml'};

/// Serves folders: {'/prefix/': folder}, with more headers if any. Resolves to {url, close()}.
export function serve(folders, headers = {}) {
    const server = http.createServer((request, response) => {
        const name = decodeURIComponent(new URL(request.url, 'http://x').pathname);
        const prefix = Object.keys(folders).find(p => name.startsWith(p));
        const file = prefix && path.join(folders[prefix], path.normalize('/' + name.slice(prefix.length)));
        if (name === "/favicon.ico") { response.writeHead(204).end(); return; }
        if (!file || !fs.existsSync(file) || !fs.statSync(file).isFile()) {
            response.writeHead(404).end();
            return;
        }
        response.writeHead(200, {'Content-Type': types[path.extname(file)] ?? 'application/octet-stream', 'Cache-Control': 'no-store', ...headers});
        fs.createReadStream(file).pipe(response);
    });
    return new Promise(resolve => server.listen(0, '127.0.0.1', () => resolve({
        url: `http://127.0.0.1:${server.address().port}`,
        close: () => server.close(),
    })));
}

/// What Chromium needs besides for WebGPU on the CPU.
export const webGpu = ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-gpu', '--enable-features=Vulkan', '--use-vulkan=swiftshader'];

/// Chromium, headless, on the CPU alone. modules: the node_modules that playwright-core is in. more: flags.
export async function launch(modules, executablePath, more = []) {
    const {chromium} = createRequire(path.join(modules, 'x.js'))('playwright-core');
    return chromium.launch({
        executablePath, headless: true,
        args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', ...more],
    });
}

/// Opens pages/NAME.mjs. Its exports can then be called with `call`.
export async function open(browser, url, name, log) {
    const page = await browser.newPage({viewport: {width: 640, height: 480}});
    page.on('console', message => log(`${name}: ${message.type()}: ${message.text()}`));
    page.on('pageerror', error => log(`${name}: ${error}`));
    page.on("crash", () => log(`${name}: crashed`));
    await page.goto(`${url}/pages/page.html?page=${name}`);
    await page.waitForFunction(() => window.ready, undefined, {timeout: 60_000});
    const failure = await page.evaluate(() => window.failure);
    if (failure) throw new Error(failure);
    return page;
}

export const call = (page, name, argument) => page.evaluate(([n, a]) => window.engine[n](a), [name, argument]);

/// A page's picture: {width, height, rgba: Float32Array of rows from the top}, in linear light.
export async function draw(page, argument) {
    const {width, height, rgba} = await call(page, 'draw', argument);
    const bytes = Buffer.from(rgba, 'base64');
    return {width, height, rgba: new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length))};
}
