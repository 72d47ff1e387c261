// The adapters of Babylon.js and PlayCanvas in headless Chromium: each engine's picture with the adapter's texture, and with the file of the program,
// whose picture tests/engines/ compares with our own renderer's.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, test} from 'node:test';
import {app, chromium, modules, root, withoutBrowser} from './chromium.mjs';
import {photograph, program, without as withoutProgram} from './program.mjs';

const work = path.join(app, 'work'), without = name => withoutBrowser(name) || withoutProgram;

let browser, server, scene, tools;
async function open(page) {
    tools ??= {...await import(path.join(root, 'tests/engines/browser/browser.mjs')), ...await import(path.join(root, 'tests/engines/browser/balls.mjs'))};
    browser ??= await tools.launch(modules, chromium);
    server ??= await tools.serve({'/pages/': path.join(root, 'tests/engines/browser/pages'), '/npm/': modules, '/files/': work});
    if (!scene) {
        fs.mkdirSync(work, {recursive: true});
        fs.copyFileSync(photograph, path.join(work, 'noon_grass.hdr'));
        const {ballsScene} = tools;
        scene = {...ballsScene, file: 'metals.glb', balls: ballsScene.balls.filter(ball => /^(metal|lambert)/.test(ball.name))};
        tools.writeScene(work, scene);
    }
    return tools.open(browser, server.url, page, line => /error/i.test(line) && console.log(`# ${line}`));
}
after(async () => {
    await browser?.close();
    server?.close();
});

/// The picture of the balls, in the values of a display, and where they are.
async function picture(page, what) {
    await tools.call(page, 'load', what);
    const {rgba} = await tools.draw(page, {model: `/files/${scene.file}`, eye: scene.eye, target: scene.target, fovDeg: scene.fovDeg, width: scene.width, height: scene.height});
    return rgba.map(v => (v <= 0.0031308 ? 12.92 * Math.max(0, v) : 1.055 * Math.min(1, v) ** (1 / 2.4) - 0.055));
}

/// RMS difference of each ball, in 1/255 of the display's range.
function differences(a, b) {
    const sums = scene.balls.map(() => [0, 0, 0]);
    for (let y = 0; y < scene.height; ++y)
        for (let x = 0; x < scene.width; ++x) {
            const seen = tools.look(scene, x + 0.5, y + 0.5);
            if (!seen) continue;
            for (let c = 0; c < 3; ++c) {
                const k = 4 * (y * scene.width + x) + c, sum = sums[seen.ball];
                sum[0] += (a[k] - b[k]) ** 2, sum[1] += b[k], ++sum[2];
            }
        }
    return Object.fromEntries(scene.balls.map(({name}, ball) => {
        const [off, all, count] = sums[ball];
        return [name, {off: 255 * Math.sqrt(off / count), mean: (255 * all) / count}];
    }));
}

function agree(context, name, a, b, most) {
    const found = differences(a, b);
    context.diagnostic(`${name}: RMS difference in 1/255: ${Object.entries(found).map(([ball, {off}]) => `${ball} ${off.toFixed(2)}`).join(', ')}`);
    for (const [ball, {off, mean}] of Object.entries(found)) {
        assert.ok(mean > 20 && mean < 250, `${name}: ${ball} is ${mean}`);
        assert.ok(off <= most, `${name}: ${ball} is off by ${off}`);
    }
}

/// The file of the program, at an exposure at which the balls are neither black nor white.
const exposure = -1;
function bakedFile(engine, extension, ...more) {
    const folder = path.join(work, [engine, ...more].join('-'));
    execFileSync(program, ['bake', path.join(work, 'noon_grass.hdr'), '-o', folder, '--for', engine, '--exposure', String(exposure), '--quiet', '--no-preview', ...more]);
    return `/files/${path.basename(folder)}/${fs.readdirSync(folder).find(name => name.endsWith(extension))}`;
}
const source = '/files/noon_grass.hdr', options = {file: {exposure}};

test('Babylon.js draws with the texture as with the file of the program', {skip: without('babylonjs')}, async context => {
    const page = await open('babylon'), prefiltered = bakedFile('babylon', '.env');
    for (const rightHanded of [false, true]) {
        const hand = rightHanded ? 'right-handed' : 'left-handed', file = await picture(page, {prefiltered, rightHanded});
        agree(context, `${hand}, of a file`, await picture(page, {source, options, rightHanded}), file, 2);
        agree(context, `${hand}, of a cube texture`, await picture(page, {source, options, rightHanded, again: true}), file, 2);
    }
    await page.close();
});

test('PlayCanvas draws with the texture as with the file of the program', {skip: without('playcanvas')}, async context => {
    const page = await open('playcanvas');
    agree(context, 'of a file', await picture(page, {source, options}), await picture(page, {atlas: bakedFile('playcanvas', '.png')}), 2);
    // A picture has its middle at +Z there.
    execFileSync(program, ['convert', path.join(work, 'noon_grass.hdr'), '--exposure', String(exposure), '-o', path.join(work, 'dim.hdr'), '--quiet']);
    const theirs = await picture(page, {atlas: bakedFile('playcanvas', '.png', '--latlong', 'usd')});
    agree(context, 'of a lat-long texture', await picture(page, {source: '/files/dim.hdr', loads: true}), theirs, 2);
    agree(context, 'of a cube texture', await picture(page, {source: '/files/dim.hdr', loads: 'cube'}), theirs, 3);
    agree(context, 'of a render target', await picture(page, {source: '/files/dim.hdr', loads: 'target'}), theirs, 3);
    await page.close();
});
