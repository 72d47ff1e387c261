// The adapters in headless Chromium: three.js' own PMREM and ours in one page, of one texture, by one lookup, beside the truth.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {after, test} from 'node:test';
import {app, chromium, modules, root, withoutBrowser} from './chromium.mjs';
import {data} from './program.mjs';
import {readHdr} from './radiance.mjs';

const without = withoutBrowser('three');

let browser, server;
async function open(name) {
    const {launch, serve} = await import(path.join(root, 'tests/engines/browser/browser.mjs'));
    browser ??= await launch(modules, chromium);
    server ??= await serve({'/npm/': modules, '/test/': import.meta.dirname, '/work/': path.join(app, 'work')});
    const page = await browser.newPage();
    page.on('pageerror', error => console.log(`# page: ${error}`));
    page.on('console', message => message.type() === 'error' && console.log(`# page: ${message.text()}`));
    await page.goto(`${server.url}/test/page.html`);
    await page.evaluate(async name => { window.tested = await import(`/test/${name}.mjs`); }, name);
    return page;
}
after(async () => {
    await browser?.close();
    server?.close();
});

/// Directions spread over the sphere.
const count = 128;
const directions = Array.from({length: count}, (_, k) => {
    const z = 1 - (2 * k + 1) / count, phi = k * Math.PI * (3 - Math.sqrt(5)), s = Math.sqrt(1 - z * z);
    return [s * Math.cos(phi), z, s * Math.sin(phi)];
}).flat();
// The levels' own roughnesses, and how many times smaller our error must be. The two last levels are 16² and 8² wide: what is read between
// their texels is off by the interpolation, whoever filtered them.
const last = 6, roughnesses = Array.from({length: last}, (_, l) => 1 - Math.sqrt(1 - (l + 1) / last)), least = [20, 20, 20, 20, 10, 2];

/// The integral in double precision: texels as points, weighted by D(n·h) n·l and their solid angle, where n = v.
function truth({data, width, height}) {
    return roughnesses.map(roughness => {
        const a2 = roughness ** 4;
        return Array.from({length: count}, (_, k) => {
            const [nx, ny, nz] = directions.slice(3 * k, 3 * k + 3), sum = [0, 0, 0];
            let weights = 0;
            for (let y = 0; y < height; ++y) {
                const theta = ((y + 0.5) * Math.PI) / height, s = Math.sin(theta), c = Math.cos(theta) * ny;
                for (let x = 0; x < width; ++x) {
                    const phi = ((x + 0.5) / width - 0.5) * 2 * Math.PI;
                    const nl = s * Math.cos(phi) * nx + c + s * Math.sin(phi) * nz;
                    if (nl <= 0) continue;
                    const d = ((1 + nl) / 2) * (a2 - 1) + 1, w = (nl * s) / (d * d), at = 3 * (y * width + x);
                    weights += w;
                    for (let i = 0; i < 3; ++i) sum[i] += w * data[at + i];
                }
            }
            return sum.map(v => v / weights);
        });
    });
}

/// Relative RMS error of RGBA values.
function errorOf(found, expected) {
    let off = 0, all = 0;
    expected.forEach((rgb, k) => rgb.forEach((v, c) => { off += (found[4 * k + c] - v) ** 2; all += v * v; }));
    return Math.sqrt(off / all);
}
const mean = values => values.filter((_, k) => k % 4 !== 3).reduce((a, b) => a + b) / (values.length * 0.75);

test("three.js reads our levels with a fraction of the error of its own, whatever the source's resolution", {skip: without || (!data && 'DOMELIGHT_DATA names no folder')}, async context => {
    const page = await open('three_page');
    fs.mkdirSync(path.join(app, 'work'), {recursive: true});
    for (const name of (process.env.DOMELIGHT_PHOTOGRAPHS ?? 'noon_grass').split(',')) {
        const picture = readHdr(path.join(data, 'env_latlong', `${name}_1k.hdr`));
        fs.writeFileSync(path.join(app, 'work', `${name}.f32`), picture.data);
        const {ours, theirs, times} = await page.evaluate(argument => window.tested.compare(argument),
            {url: `/work/${name}.f32`, width: picture.width, height: picture.height, directions, roughnesses, options: {}});
        const expected = truth(picture);
        roughnesses.forEach((roughness, l) => {
            const own = errorOf(ours[0][l], expected[l]), other = errorOf(theirs[0][l], expected[l]);
            const change = ([full, half]) => Math.abs(mean(half[l]) / mean(full[l]) - 1);
            context.diagnostic(`${name}: roughness ${roughness.toFixed(3)}: error ${own.toExponential(1)} (three.js ${other.toExponential(1)}: ` +
                               `${(other / own).toFixed(0)} times); half the resolution changes the mean by ${change(ours).toExponential(1)} (${change(theirs).toExponential(1)})`);
        });
        context.diagnostic(`${name}: ${Object.values(times).map(t => t.toFixed(0)).join(' and ')} ms until the texture is there`);
        roughnesses.forEach((roughness, l) => {
            assert.ok(errorOf(ours[0][l], expected[l]) <= errorOf(theirs[0][l], expected[l]) / least[l], `roughness ${roughness}`);
            assert.ok(Math.abs(mean(ours[1][l]) / mean(ours[0][l]) - 1) <= 0.002, `roughness ${roughness}`);
        });
    }
});

test('a cube that three.js has drawn is baked as it lies', {skip: without}, async () => {
    const page = await open('three_page');
    const [sharp] = await page.evaluate(() => window.tested.probe());
    const near = (k, rgb) => rgb.forEach((v, c) => assert.ok(Math.abs(sharp[4 * k + c] - v) < 0.01, `direction ${k}: ${sharp.slice(4 * k, 4 * k + 3)}`));
    near(0, [4, 0, 0]);
    near(1, [0.5, 0.25, 1]);
    near(3, [0.5, 0.25, 1]);
});

test('a cube of pictures and an equirectangular render target are baked as three.js shows them', {skip: without}, async () => {
    const page = await open('three_page'), {theirs, ours, picture, target} = await page.evaluate(() => window.tested.cubes());
    ours[0].forEach((v, k) => assert.ok(Math.abs(v - theirs[0][k]) < 0.02 || k % 4 === 3, `axis ${k >> 2}: ${ours[0].slice(k & ~3, (k & ~3) + 3)}, three.js ${theirs[0].slice(k & ~3, (k & ~3) + 3)}`));
    for (const level of [0, 1]) target[level].forEach((v, k) => assert.ok(Math.abs(v - picture[level][k]) < 2e-3, `level ${level}, axis ${k >> 2}`));
});
