// Real engines load the files that the program bakes, in a headless browser, and their pictures are measured. Called by run_browser.sh.
//
//   node run.mjs PROGRAM CHROMIUM MODULES WORK [--only NAME] [--all] [--sheet FILE]

import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {execFileSync} from 'node:child_process';
import {ballsScene, mirrorScene, roughnesses, writeScene} from './balls.mjs';
import {call, draw, launch, open, serve} from './browser.mjs';
import {entries} from './engines.mjs';
import {testFormats} from './formats.mjs';
import {testProbes} from './probes.mjs';
import {onScreen, readHdr, writeConstantHdr, writePng} from './files.mjs';
import {albedoOf, axes, ballErrors, ballMeans, drawMetals, filteredLight, findLabels, likeness} from './measure.mjs';
import {Claims} from './claims.mjs';

const [program, chromium, modules, work, ...options] = process.argv.slice(2);
const option = name => (options.includes(name) ? options[options.indexOf(name) + 1] : undefined);
const here = path.dirname(fileURLToPath(import.meta.url));

const claims = new Claims(), {claim, skip} = claims;

const domelight = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe'], encoding: 'utf8'});
const filesIn = folder => fs.readdirSync(folder, {recursive: true}).filter(name => fs.statSync(path.join(folder, name)).isFile());

// The evening sky's brightest part then comes to 0.87: some engines' pictures end at 1.
const exposure = environment => (environment === 'sky.hdr' ? ['--exposure', 1.3] : []);

// The names that an option accepts, read from the help: between bars, or in a table with a line for each, which is indented deeper than the options.
const help = domelight('bake', '--help');
const accepted = option => new RegExp(`${option} ([a-z0-9-]+(?:\\|[a-z0-9-]+)+)`).exec(help)[1].split('|');
const listed = option => {
    const table = new RegExp(`^  ${option} .*\\n((?:    .*\\n)+)`, 'm').exec(help)[1];
    return [...table.matchAll(/^ {6}([a-z0-9-]+)  /gm)].map(line => line[1]);
};
const engineNames = listed('--for');

/// Bakes an environment of the work folder once for each engine and further options: the folder's name in it.
const bakes = new Map();
function bake(environment, engine, more = []) {
    const folder = [path.parse(environment).name, engine, ...more].join('-').replaceAll('--', '');
    if (!bakes.has(folder)) {
        domelight('bake', path.join(work, environment), '-o', path.join(work, folder), '--for', engine, '--quiet', '--no-preview',
                  ...exposure(environment), ...more);
        bakes.set(folder, filesIn(path.join(work, folder)));
    }
    return {folder, names: bakes.get(folder)};
}

const picturesOf = {};

/// Keeps a picture as PNG: the values as they are, with sRGB's curve.
function keep(name, picture) {
    const rgb = Buffer.alloc(3 * picture.width * picture.height);
    for (let k = 0; k < rgb.length / 3; ++k)
        for (let c = 0; c < 3; ++c) rgb[3 * k + c] = Math.round(255 * onScreen(picture.rgba[4 * k + c]));
    writePng(path.join(work, 'pictures', `${name}.png`), picture.width, picture.height, rgb);
    picturesOf[name] = {width: picture.width, height: picture.height, rgb};
}

const shot = (page, scene, more = {}) =>
    draw(page, {model: `/files/${scene.file}`, eye: scene.eye, target: scene.target, fovDeg: scene.fovDeg, width: scene.width, height: scene.height, ...more});

const percent = v => `${(100 * v).toFixed(2)} %`;

async function testAxes(entry, page, environment) {
    const picture = await shot(page, mirrorScene);
    keep(`${entry.name}-mirror`, picture);
    const found = findLabels(mirrorScene, environment, picture);
    for (const name of Object.keys(axes)) {
        const {at, shift, pixels, matching} = found[name];
        const wrong = [];
        if (pixels < 50) wrong.push(`only ${pixels} pixels to judge by`);
        if (!(matching >= 0.98)) wrong.push(`${percent(1 - matching)} of its ${pixels} pixels have another colour`);
        if (Math.hypot(...shift) > 1) wrong.push(`it is ${shift} pixels from ${at.map(v => v.toFixed(0))}`);
        claim(`${entry.name}: the label ${name} is where a mirror shows ${name}`, wrong,
              `about ${at.map(v => v.toFixed(0))}, shifted by ${shift}; ${percent(matching)} of ${pixels} pixels right`);
    }
}

async function testFurnace(entry, picture) {
    keep(`${entry.name}-furnace`, picture);
    const means = ballMeans(ballsScene, picture, 0.9);
    for (const name of Object.keys(means).filter(n => n.startsWith('metal') || n === 'lambert')) {
        const off = Math.max(...means[name].map(v => Math.abs(v - 1)));
        claim(`${entry.name}: in a white furnace ${name} is white within ${percent(entry.furnace)}`,
              off <= entry.furnace ? [] : [`it is ${means[name].map(v => v.toFixed(4))}`], `off by ${percent(off)}`);
    }
}

/// Levels that are one grey each: 57/64 in the first, 9/64 in the last, exact in every encoding here.
const levelGrey = (level, count) => Math.round(64 * (0.89 - 0.75 * level / (count - 1))) / 64;

async function testLevels(entry, page, bakeOf, load, furnace) {
    const {folder, names} = bakeOf;
    const copy = `${folder}-levels`;
    fs.cpSync(path.join(work, folder), path.join(work, copy), {recursive: true});
    const chain = entry.chain(names);
    const values = entry.repaint(path.join(work, folder, chain), path.join(work, copy, chain), levelGrey);
    await call(page, 'load', load(copy));
    const picture = await shot(page, ballsScene);
    keep(`${entry.name}-levels`, picture);
    // About the centre, where the normal turns by 1 / radius from pixel to pixel. Dividing by the picture in the furnace cancels all other effects of
    // the material.
    const seen = ballMeans(ballsScene, picture, 0.2), white = ballMeans(ballsScene, furnace, 0.2);
    const radius = ballsScene.radius * ballsScene.height / 4;
    const size = JSON.parse(fs.readFileSync(path.join(work, folder, 'manifest.json'))).specular?.levels?.[0]?.size;
    for (const roughness of roughnesses) {
        const last = values.length - 1;
        const level = Math.min(last, entry.level(entry.roughness(roughness, 1 / radius), last, size));
        const low = Math.min(last - 1, Math.floor(level));
        const shown = entry.shown ?? (v => v);
        const seenRoughness = entry.roughness(roughness, 1 / radius);
        const expected = shown(values[low] + (level - low) * (values[low + 1] - values[low]),
                               {first: values[0], last: values[last], alpha: seenRoughness ** 2, albedo: albedoOf(1, seenRoughness)});
        const value = seen[`metal ${roughness}`][1] / white[`metal ${roughness}`][1];
        claim(`${entry.name}: roughness ${roughness} reads level ${level.toFixed(2)} of 0 to ${last}`,
              Math.abs(value - expected) <= 0.012 ? [] : [`it reads ${value.toFixed(3)} and not ${expected.toFixed(3)}`],
              `${value.toFixed(3)} for ${expected.toFixed(3)}`);
    }
}

/// Our own renderer's picture of the balls under the sky, as a real-time engine draws them.
function splitSum() {
    const file = path.join(work, 'reference.hdr');
    if (!fs.existsSync(file))
        domelight('render', path.join(work, ballsScene.file), '--env', path.join(work, 'sky.hdr'), ...exposure('sky.hdr'), '--shading', 'split-sum',
                  '--multiple-scattering', '--occlusion', 'off', '--background', 'transparent', '--width', ballsScene.width, '--height',
                  ballsScene.height, '--camera-position', ballsScene.eye.join(), '--fov-deg', ballsScene.fovDeg, '--spp', 16, '--quiet', '-o', file);
    const {width, height, rgb} = readHdr(file);
    const rgba = new Float32Array(4 * width * height);
    for (let k = 0; k < width * height; ++k) rgba.set(rgb.subarray(3 * k, 3 * k + 3), 4 * k);
    return {width, height, rgba};
}

/// The sky filtered for five roughnesses, exactly.
let skyLevels;
function filteredSky() {
    if (!skyLevels) {
        const folder = path.join(work, 'sky-levels');
        domelight('bake', path.join(work, 'sky.hdr'), ...exposure('sky.hdr'), '-o', folder, '--layout', 'latlong', '--format', 'hdr', '--size', 256,
                  '--levels', roughnesses.length, '--roughness', roughnesses.join(), '--quiet', '--no-preview');
        const {specular} = JSON.parse(fs.readFileSync(path.join(folder, 'manifest.json')));
        skyLevels = filteredLight(specular.levels.map(level => readHdr(path.join(folder, level.file))));
    }
    return skyLevels;
}

async function testBrightness(entry, page) {
    const picture = await shot(page, ballsScene);
    keep(`${entry.name}-sky`, picture);
    const ours = splitSum();
    drawMetals(ballsScene, ours, filteredSky(), entry.metal, entry.roughness);
    keep(`${entry.name}-sky-reference`, ours);
    const theirs = ballMeans(ballsScene, picture, 0.9), expected = ballMeans(ballsScene, ours, 0.9), errors = ballErrors(ballsScene, picture, ours, 0.9);
    for (const {name} of ballsScene.balls) {
        if (entry.plastics === false && name.startsWith('plastic')) continue;
        const off = Math.max(...theirs[name].map((v, c) => Math.abs(v / expected[name][c] - 1)));
        const wrong = [];
        if (!(off <= entry.tolerance)) wrong.push(`it is ${theirs[name].map(v => v.toFixed(4))} and not ${expected[name].map(v => v.toFixed(4))}`);
        // Pixel by pixel less closely: levels are mixed linearly, and a mirror is a little blurred.
        if (!(errors[name] <= (name === 'metal 0' ? 0.07 : 0.03))) wrong.push(`its pixels are off by ${percent(errors[name])} RMS`);
        claim(`${entry.name}: under a sky, ${name} is as bright as our reference within ${percent(entry.tolerance)}`, wrong,
              `means off by ${percent(off)}, pixels by ${percent(errors[name])} RMS`);
    }
}

/// Takes the sun out of a sky: its lights and what is left of the sky must light matte balls as the whole sky does.
async function testLights(entry, page) {
    const sky = path.join(work, 'sunny.hdr'), folder = path.join(work, 'lights'), dimmed = ['--exposure', -8];
    domelight('sky', '--sun-elevation-deg', 40, '--sun-azimuth-deg', 60, '--height', 256, '-o', sky, '--quiet');
    domelight('lights', sky, ...dimmed, '-o', folder, '--no-preview', '--quiet');
    const {lights} = JSON.parse(fs.readFileSync(path.join(folder, 'lights.json')));
    const remainder = bake('lights/remainder.hdr', entry.engine, entry.options);
    await call(page, 'load', entry.files(`/files/${remainder.folder}/`, remainder.names));
    const loaded = await call(page, 'loadLights', '/files/lights/lights.gltf');
    const off = Math.max(...lights.flatMap((light, k) => light.irradiance.map((e, c) => Math.abs(loaded[k].color[c] * loaded[k].intensity / e - 1))));
    claim(`${entry.name}: the intensity of a light is its irradiance in the environment's unit`,
          loaded.length === lights.length && off < 1e-4 ? [] : [`${JSON.stringify(loaded)} for ${JSON.stringify(lights.map(l => l.irradiance))}`],
          `off by ${percent(off)}`);
    const picture = await shot(page, ballsScene), file = path.join(work, 'sunny-reference.hdr');
    keep(`${entry.name}-lights`, picture);
    domelight('render', path.join(work, ballsScene.file), '--env', sky, ...dimmed, '--occlusion', 'off', '--background', 'transparent', '--width', ballsScene.width,
              '--height', ballsScene.height, '--camera-position', ballsScene.eye.join(), '--fov-deg', ballsScene.fovDeg, '--spp', 64, '--quiet', '-o', file);
    const whole = readHdr(file), rgba = new Float32Array(4 * whole.width * whole.height);
    for (let k = 0; k < whole.width * whole.height; ++k) rgba.set(whole.rgb.subarray(3 * k, 3 * k + 3), 4 * k);
    const seen = ballMeans(ballsScene, picture, 0.9).lambert, expected = ballMeans(ballsScene, {...whole, rgba}, 0.9).lambert;
    const error = Math.max(...seen.map((v, c) => Math.abs(v / expected[c] - 1)));
    claim(`${entry.name}: lights and remainder light a matte ball as the whole sky does within ${percent(entry.tolerance)}`,
          error <= entry.tolerance ? [] : [`it is ${seen.map(v => v.toFixed(4))} and not ${expected.map(v => v.toFixed(4))}`], `off by ${percent(error)}`);
}

/// The engine's own tool baked a photograph, and so do we: both must light the mirror ball alike.
async function testTheirs(entry, page) {
    const data = process.env.DOMELIGHT_DATA && path.join(process.env.DOMELIGHT_DATA, 'reference/symmetrical_garden');
    const {by, latlong, files, brightness} = entry.theirs;
    if (!data || !fs.existsSync(data)) return skip(`${entry.name}: the bake by ${by} is not in DOMELIGHT_DATA`);
    fs.cpSync(data, path.join(work, 'theirs'), {recursive: true});
    const folder = `ours-${entry.name}`;
    domelight('bake', path.join(data, 'symmetrical_garden_1k.hdr'), '-o', path.join(work, folder), '--for', entry.engine, '--latlong', latlong,
              '--quiet', '--no-preview', ...(entry.options ?? []));
    await call(page, 'load', entry.files(`/files/${folder}/`, filesIn(path.join(work, folder))));
    const ours = await shot(page, mirrorScene);
    await call(page, 'load', files('/files/theirs/'));
    const theirs = await shot(page, mirrorScene);
    keep(`${entry.name}-garden`, ours);
    keep(`${entry.name}-garden-theirs`, theirs);
    const alike = likeness(mirrorScene, ours, theirs);
    claim(`${entry.name}: turned as the bake of the same picture by ${by}`, alike > 0.95 ? [] : [`correlation ${alike.toFixed(3)}`],
          `correlation ${alike.toFixed(3)}`);
    const cut = picture => ballMeans(mirrorScene, {...picture, rgba: picture.rgba.map(v => Math.min(1, v))}, 0.95).mirror;
    const a = cut(ours), b = cut(theirs), off = Math.max(...a.map((v, c) => Math.abs(v / b[c] - 1)));
    claim(`${entry.name}: as bright as the bake by ${by} within ${percent(brightness)}`,
          off <= brightness ? [] : [`${a.map(v => v.toFixed(3))} and not ${b.map(v => v.toFixed(3))}`], `off by ${percent(off)}`);
}

async function testEngine(entry, browser, server, log, axesImage) {
    if (!engineNames.includes(entry.engine)) return skip(`${entry.name}: the program does not bake for it`);
    const environments = entry.axesOnly ? ['axes.hdr'] : ['axes.hdr', 'white.hdr', 'sky.hdr'];
    const bakesOf = Object.fromEntries(environments.map(environment => [environment, bake(environment, entry.engine, entry.options)]));
    if (!entry.picks(bakesOf['axes.hdr'].names)) return skip(`${entry.name}: bake --for ${entry.engine} does not write its file`);
    const page = await open(browser, server.url, entry.page, log);
    console.log(`${entry.name}: version ${await page.evaluate(() => window.engine.version)}`);
    const load = environment => folder => entry.files(`/files/${folder}/`, bakesOf[environment].names, `/files/${environment}`);
    const lit = environment => call(page, 'load', load(environment)(bakesOf[environment].folder));
    await lit('axes.hdr');
    await testAxes(entry, page, axesImage);
    if (entry.axesOnly) return page.close();
    await lit('white.hdr');
    const furnace = await shot(page, ballsScene);
    await testFurnace(entry, furnace);
    if (entry.chain) await testLevels(entry, page, bakesOf['white.hdr'], load('white.hdr'), furnace);
    await lit('sky.hdr');
    await testBrightness(entry, page);
    if (entry.theirs) await testTheirs(entry, page);
    if (entry.lights) await testLights(entry, page);
    await page.close();
}

/// The lines that a page of docs/engines/ shows are those that run here.
function testDocs() {
    const folder = path.join(here, '../../../docs/engines');
    for (const name of fs.readdirSync(path.join(here, 'pages'))) {
        const lines = fs.readFileSync(path.join(here, 'pages', name), 'utf8').split('\n');
        lines.forEach((line, first) => {
            const page = /^ *\/\/ docs\/engines\/(\w+\.md)/.exec(line);
            if (!page) return;
            const block = lines.slice(first + 1, lines.findIndex((l, k) => k > first && l.trim() === '// end')).map(l => l.slice(4)).join('\n');
            const text = fs.readFileSync(path.join(folder, page[1]), 'utf8');
            claim(`docs/engines/${page[1]} shows what ${name} runs`, text.includes(`\`\`\`js\n${block}\n\`\`\`\n`) ? [] : [`it lacks:\n${block}`]);
        });
    }
}

/// The mirror balls that were drawn, side by side, and below each its balls under the sky.
function writeSheet(file) {
    const names = entries.map(c => c.name).filter(name => picturesOf[`${name}-sky`]), cell = 320, height = 256 + 128;
    const rgb = Buffer.alloc(3 * cell * names.length * height);
    names.forEach((name, k) => {
        for (const [part, left, top] of [['mirror', 32, 0], ['sky', 0, 256]]) {
            const picture = picturesOf[`${name}-${part}`];
            for (let y = 0; y < picture.height; ++y)
                picture.rgb.copy(rgb, 3 * ((top + y) * cell * names.length + k * cell + left), 3 * y * picture.width, 3 * (y + 1) * picture.width);
        }
    });
    writePng(file, cell * names.length, height, rgb);
}

fs.rmSync(work, {recursive: true, force: true});
fs.mkdirSync(path.join(work, 'pictures'), {recursive: true});
for (const scene of [mirrorScene, ballsScene]) writeScene(work, scene);
writeConstantHdr(path.join(work, 'white.hdr'), 1, 256);
writePng(path.join(work, 'white.png'), 1, 1, Buffer.from([255, 255, 255]));
domelight('sky', '--axes', '-o', path.join(work, 'axes.hdr'), '--quiet');
domelight('sky', '--sun-elevation-deg', -4, '-o', path.join(work, 'sky.hdr'), '--quiet');

const server = await serve({'/pages/': path.join(here, 'pages'), '/npm/': modules, '/files/': work});
const browser = await launch(modules, chromium);
const browserLog = fs.createWriteStream(path.join(work, 'browser.log'));
const log = line => browserLog.write(`${line}\n`);
try {
    const axesImage = readHdr(path.join(work, 'axes.hdr'));
    for (const entry of entries) {
        if (option('--only') ? option('--only') !== entry.name : entry.slow && !options.includes('--all')) continue;
        const start = process.uptime();
        try {
            await testEngine(entry, browser, server, log, axesImage);
        } catch (error) {
            claim(`${entry.name}: loads and draws`, [String(error.stderr ?? error.stack ?? error)]);
        }
        console.log(`${entry.name}: ${(process.uptime() - start).toFixed(1)} s`);
    }
    if (!option('--only') || option('--only') === 'formats')
        await testFormats({claim, skip, domelight, work, modules, browser, server, log, encodings: accepted('--encoding')})
            .catch(error => claim('formats', [String(error.stderr || error.stack)]));
    if (!option('--only') || option('--only') === 'probes')
        await testProbes({claim, domelight, work, browser, server, log, keep}).catch(error => claim('probes', [String(error.stderr || error.stack)]));
    testDocs();
    if (option('--sheet')) writeSheet(option('--sheet'));
} finally {
    await browser.close();
    server.close();
}
console.log(`engines: ${claims.passed} passed, ${claims.failed} failed, ${claims.skipped} skipped`);
process.exit(claims.failed ? 1 : 0);
