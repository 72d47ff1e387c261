// The page itself: keys, the address, bad files, a lost graphics context, a phone, and accessibility.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {openFile, setState} from './frames.mjs';

const state = (page, key) => page.evaluate(key => domelight.store.state[key], key);
const settle = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));

async function testKeys({open, claim}) {
    const page = await open('#other=phong', {viewport: {width: 720, height: 400}});
    const press = async (key, what, expected, name) => {
        await page.keyboard.press(key);
        await settle(page);
        const value = await state(page, name);
        const right = typeof expected === 'function' ? expected(value) : value === expected;
        claim(`keys: ${key} ${what}`, right ? [] : [`${name} is ${value}`]);
    };
    for (const [k, mode] of ['split-sum', 'stretched', 'phong', 'mirror', 'refract', 'monte-carlo'].entries()) await press(`${k + 1}`, `chooses ${mode}`, mode, 'mode');
    await press('1', 'chooses split-sum again', 'split-sum', 'mode');
    await press('s', 'splits the screen', 'split', 'view');
    await press('s', 'ends the split', 'one', 'view');
    await press('e', 'shows FLIP', 'flip', 'view');
    await press('d', 'shows the difference', 'difference', 'view');
    await press('d', 'ends it', 'one', 'view');
    await press('a', 'flips to the other method', 'phong', 'mode');
    await press('a', 'flips back', 'split-sum', 'mode');
    await press(']', 'raises the exposure', v => v > 0.3, 'exposure');
    await press('[', 'lowers it', 0, 'exposure');
    await press('h', 'folds the panel', false, 'panel');
    await press('h', 'shows it again', true, 'panel');
    const eye = await state(page, 'eye');
    await press('ArrowLeft', 'orbits', v => String(v) !== String(eye), 'eye');
    await press('Shift+ArrowLeft', 'turns the light', 5, 'turn');
    await press('+', 'comes nearer', v => Math.hypot(...v) < Math.hypot(...eye) - 1, 'eye');
    await press('r', 'shows the whole model', v => Math.hypot(...v.map((x, k) => x - eye[k])) < 1e-6, 'eye');
    await page.keyboard.press('?');
    claim('keys: ? opens the help', await page.locator('dialog').isVisible() ? [] : ['it is closed']);
    await page.keyboard.press('Escape');
    claim('keys: Escape closes it', await page.locator('dialog').isVisible() ? ['it is open'] : []);
    const download = page.waitForEvent('download');
    await page.keyboard.press('p');
    claim('keys: P saves a screenshot', fs.statSync(await (await download).path()).size > 5000 ? [] : ['it is empty']);
    claim('keys: the console is silent', page.complaints);
    await page.close();
}

/// The page is there before its program, and keeps what is dropped meanwhile.
async function testStart({browser, watch, server, claim, work, program}) {
    execFileSync(program, ['sky', '-o', path.join(work, 'early.hdr'), '--height', '64', '--no-sun-disc', '--quiet']);
    const page = watch(await browser.newPage({viewport: {width: 720, height: 400}}));
    let release;
    const held = new Promise(done => (release = done));
    await page.route(/\/start-[^/]*\.js$/, async route => {
        await held;
        await route.continue();
    });
    await page.goto(`${server.url}/app/index.html`, {waitUntil: 'commit'});
    await page.waitForFunction(() => performance.getEntriesByName('first-paint').length && performance.getEntriesByName('laid out').length, undefined, {timeout: 20_000});
    const boxes = await page.evaluate(() => ['#panel', '#modes', '#view canvas'].map(selector => document.querySelector(selector)?.getBoundingClientRect().width ?? 0));
    claim('start: panel, methods and canvas are there before the program', boxes.every(width => width > 200) ? [] : [String(boxes)]);
    await page.evaluate(async () => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([await (await fetch('/work/early.hdr')).arrayBuffer()], 'early.hdr'));
        dispatchEvent(new DragEvent('drop', {dataTransfer: transfer, cancelable: true}));
    });
    release();
    await page.waitForFunction(() => window.domelight?.app.environmentName === 'early.hdr', undefined, {timeout: 30_000});
    claim('start: a file that was dropped before is opened', []);
    claim('start: the console is silent', page.complaints);
    await page.close();
}

/// The camera by the mouse, and what a folded panel changes.
async function testView({open, claim}) {
    const page = await open('#fullResolution=true', {viewport: {width: 720, height: 300}}), target = () => state(page, 'target'), before = await target();
    await page.waitForFunction(() => domelight.stage.panes[0].count >= 6, undefined, {timeout: 30_000});
    await page.evaluate(() => domelight.store.set({panel: false}));
    await page.waitForFunction(() => domelight.stage.inset.right === 0 && domelight.stage.panes[0].count > 0, undefined, {timeout: 10_000});
    const count = await page.evaluate(() => domelight.stage.panes[0].count);
    claim('view: frames of a panel that is open and folded are not mixed', count < 6 ? [] : [`${count} frames are in the mean`]);
    await page.mouse.dblclick(360, 105);
    await settle(page);
    const near = await target(), eye = await state(page, 'eye');
    claim('view: a double click comes nearer to the ball there', near[1] > 0.3 && near[2] > 0.2 && Math.hypot(...eye.map((v, k) => v - near[k])) < 11 ? [] : [`${near}, seen from ${eye}`]);
    const free = await page.evaluate(() => {
        for (let y = 60; y < 240; y += 10)
            for (let x = 20; x < 700; x += 10) if (document.elementFromPoint(x, y).tagName === 'CANVAS' && !domelight.stage.surfaceAt(x / innerWidth, y / innerHeight)) return [x, y];
    });
    await page.mouse.dblclick(...free);
    await settle(page);
    claim('view: a double click beside the model shows all of it', String(await target()) === String(before) ? [] : [String(await target())]);
    await setState(page, {model: 'none'});
    await page.waitForFunction(() => domelight.ready && domelight.app.model.name === 'none', undefined, {timeout: 10_000});
    await page.keyboard.press('+');
    await settle(page);
    const shown = await page.evaluate(() => [domelight.store.state.fov, document.querySelector('header p').textContent, document.title]);
    claim('view: the environment alone can be looked at, more closely too', shown[0] < 59 && shown[1] === 'studio' ? [] : [String(shown)]);
    claim('view: the console is silent', page.complaints);
    await page.close();
}

async function testAddress({open, claim, work}) {
    const page = await open('#mode=refract&lookup=sphere-map&exposure=1.5&eye=1,2,3&size=nonsense&unknown=7&tonemap=wrong');
    const wrong = [];
    for (const [key, value] of Object.entries({mode: 'refract', lookup: 'sphere-map', exposure: 1.5, eye: [1, 2, 3], size: 256, tonemap: 'agx'})) {
        const found = await state(page, key);
        if (String(found) !== String(value)) wrong.push(`${key} is ${found}`);
    }
    claim('address: what is understood is taken, the rest is left out', wrong);
    await setState(page, {mode: 'phong', exposure: 0, tonemap: 'neutral'});
    await page.waitForTimeout(500);
    const hash = new URL(page.url()).hash;
    claim('address: it follows what is chosen', /mode=phong/.test(hash) && /tonemap=neutral/.test(hash) && !/exposure/.test(hash) ? [] : [hash]);
    claim('address: the console is silent', page.complaints);
    await page.close();
    // With a scene that the program serves, too.
    const session = path.join(work, 'api/session'), before = fs.readFileSync(session, 'utf8');
    fs.writeFileSync(session, JSON.stringify({...JSON.parse(before), scene: {name: 'draco.glb', url: '/models/draco.glb'}}));
    const served = await open('#eye=1,2,3');
    fs.writeFileSync(session, before);
    const [name, eye] = await served.evaluate(() => [domelight.app.model.name, domelight.store.state.eye]);
    claim('address: a view of a served scene is kept', name === 'draco.glb' && String(eye) === '1,2,3' ? [] : [`${name} from ${eye}`]);
    await served.close();
}

/// Writes a file into the folder that the server serves; its address.
const served = (work, name, bytes) => {
    fs.writeFileSync(path.join(work, name), bytes);
    return [`/work/${name}`, name];
};

async function testBadFiles({open, claim, work}) {
    const page = await open(), hdr = (size, body) => Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n${size}\n`), body]);
    const files = {
        'empty.hdr': Buffer.alloc(0), 'noise.exr': Buffer.from(Array.from({length: 4000}, (_, k) => (k * 7919) % 251)), 'text.txt': Buffer.from('not a picture'),
        'cut.hdr': hdr('-Y 64 +X 128', Buffer.alloc(900, 1)), 'square.hdr': hdr('-Y 4 +X 4', Buffer.alloc(64, 100)), 'huge.hdr': hdr('-Y 100000 +X 200000', Buffer.alloc(64, 100)),
        'cut.exr': Buffer.from([0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]), 'cut.glb': Buffer.from('glTF\x02\0\0\0\xff\xff\0\0', 'latin1'), 'empty.gltf': Buffer.from('{"asset":{"version":"2.0"}}'),
    };
    const before = await page.evaluate(() => [domelight.app.model.name, domelight.app.environmentName].join());
    for (const [name, bytes] of Object.entries(files)) {
        await openFile(page, ...served(work, name, bytes));
        const said = await page.locator('#notes p').last().textContent(), after = await page.evaluate(() => [domelight.app.model.name, domelight.app.environmentName].join());
        const wrong = [];
        if (!said.startsWith(name) || !/\.$/.test(said)) wrong.push(`the page says "${said}"`);
        if (after !== before) wrong.push(`the page shows ${after}`);
        claim(`bad files: ${name} gives a sentence and changes nothing`, wrong, said);
    }
    await page.locator('#notes button').first().click();
    claim('bad files: a sentence can be closed', (await page.locator('#notes p').count()) === 2 ? [] : ['it stays']);
    await page.evaluate(() => domelight.app.events.told('A hint.'));
    claim('bad files: a hint looks different from an error', (await page.locator('#notes .hint').count()) === 1 ? [] : ['it does not']);
    claim('bad files: the console is silent', page.complaints);
    await page.close();
}

/// Compressed models, by decoders that the content security policy lets run.
async function testModels({open, claim, server}) {
    const page = await open('#panel=false', {viewport: {width: 320, height: 320}});
    const colour = async (x, y) => {
        await page.waitForFunction(() => domelight.ready, undefined, {timeout: 30_000});
        return page.evaluate(([x, y]) => {
            const {stage} = domelight, {width, height} = stage.panes[0], values = new Float32Array(4);
            stage.renderer.readRenderTargetPixels(stage.panes[0].target, Math.round(x * width), Math.round(y * height), 1, 1, values);
            return [...values];
        }, [x, y]);
    };
    for (const [name, x, y, brightest] of [['draco.glb', 0.5, 0.5, 0], ['ktx2.glb', 0.35, 0.65, 0], ['ktx2.glb', 0.65, 0.65, 1], ['ktx2.glb', 0.5, 0.35, 2]]) {
        await openFile(page, `${server.url}/models/${name}`, name);
        const rgb = (await colour(x, y)).slice(0, 3), shown = await page.evaluate(() => domelight.app.model.name);
        claim(`models: ${name} has its colour at ${x}, ${y}`, shown === name && rgb.every((v, k) => k === brightest || v < 0.8 * rgb[brightest]) ? [] : [`${shown}: ${rgb}`]);
    }
    claim('models: the console is silent', page.complaints);
    await page.close();
}

/// One light in several projections has one mean.
async function testProjections({open, claim, work, program}) {
    const page = await open('#panel=false', {viewport: {width: 160, height: 120}}), run = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe']});
    const mean = () => page.evaluate(() => domelight.app.bake.sh[1]);
    run('sky', '-o', path.join(work, 'projected.hdr'), '--height', 128, '--no-sun-disc', '--quiet');
    await openFile(page, '/work/projected.hdr', 'projected.hdr');
    const expected = await mean();
    for (const [projection, word, ...more] of [['cube', 'auto', '--layout', 'cross'], ['angular', 'angular'], ['octahedral', 'octahedral']]) {
        const name = `${projection}.hdr`;
        run('convert', path.join(work, 'projected.hdr'), '-o', path.join(work, name), '--to', projection, '--size', projection === 'cube' ? 64 : 256, ...more, '--quiet');
        await setState(page, {projection: word});
        await openFile(page, `/work/${name}`, name);
        const found = await mean(), shown = await page.evaluate(() => domelight.app.environmentName);
        claim(`projections: ${projection} lights as the lat-long map does`, shown === name && Math.abs(found / expected - 1) < 0.02 ? [] : [`${shown}: ${found} for ${expected}`], `${(100 * (found / expected - 1)).toFixed(2)} %`);
    }
    claim('projections: the console is silent', page.complaints);
    await page.close();
}

/// Gold balls that stand above red ones become redder below when they see them, and move.
async function testLive({open, claim}) {
    const page = await open('#panel=false&fullResolution=true', {viewport: {width: 240, height: 120}});
    const below = () => page.evaluate(async () => {
        await domelight.paneAt(2, 0);
        const {stage} = domelight, {width, height} = stage.panes[0], values = new Float32Array(4), unit = width / 7.3;
        stage.renderer.readRenderTargetPixels(stage.panes[0].target, Math.round(width / 2), Math.round(height / 2 + 0.18 * unit), 1, 1, values);
        return values[0] / values[2];
    });
    const alone = await below();
    await page.evaluate(() => domelight.store.set({live: true}));
    await page.waitForFunction(() => domelight.store.state.live && domelight.app.liveCubes.done && domelight.stage.objects.every(object => object.live), undefined, {timeout: 60_000});
    const among = await below();
    claim('live cubes: a ball sees the one below', among > 1.3 * alone ? [] : [`red over blue was ${alone} and is ${among}`], `red over blue ${alone.toFixed(2)}, then ${among.toFixed(2)}`);
    await setState(page, {live: false});
    claim('live cubes: switched off, it sees the environment alone', Math.abs((await below()) / alone - 1) < 1e-3 ? [] : ['the colour stays']);
    const place = () => page.evaluate(() => domelight.app.model.root.children[0].position.z);
    await page.evaluate(() => domelight.store.set({motion: true}));
    await page.waitForFunction(() => domelight.app.model.root.children[0].position.z !== 0, undefined, {timeout: 30_000});
    await setState(page, {motion: false});
    claim('motion: the model moves, and returns', (await place()) === 0 ? [] : [`it is at ${await place()}`]);
    claim('live cubes: the console is silent', page.complaints);
    await page.close();
}

/// The page's mean FLIP of two methods is that of `domelight compare`.
async function testFlip({open, claim, work, program}) {
    const page = await open('#panel=false&fullResolution=true&mode=split-sum&other=phong&view=split&divider=1', {viewport: {width: 240, height: 120}});
    await page.waitForFunction(() => domelight.app.least >= 64, undefined, {timeout: 60_000});
    const shown = async (divider, file) => {
        const url = await page.evaluate(divider => {
            const {stage, app} = domelight;
            stage.show({...app.state, divider});
            return stage.renderer.domElement.toDataURL();
        }, divider);
        fs.writeFileSync(path.join(work, file), Buffer.from(url.split(',')[1], 'base64'));
    };
    await shown(2, 'flip-left.png');
    await shown(-1, 'flip-right.png');
    await page.evaluate(() => domelight.store.set({view: 'flip'}));
    const text = await page.waitForFunction(() => [...document.querySelectorAll('#panel .note')].map(n => n.textContent).find(t => /mean FLIP/.test(t)), undefined, {timeout: 30_000});
    const found = Number(/mean FLIP ([\d.]+)/.exec(await text.jsonValue())[1]);
    let output;
    try {
        output = execFileSync(program, ['compare', path.join(work, 'flip-left.png'), path.join(work, 'flip-right.png'), '--json'], {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
    } catch (error) {
        output = error.stdout;
    }
    const {flip} = JSON.parse(output).errors;
    claim('FLIP: the page has the number of `domelight compare`', flip > 0.005 && Math.abs(found - flip) < 2e-4 ? [] : [`${found}, and the program ${flip}`], `${found} and ${flip.toFixed(4)}`);
    await page.close();
}

/// The files of an engine that the page bakes are those of `domelight bake`, but for the last bits of filtered floats.
async function testExport({all, open, claim, program, work}) {
    const page = await open('', {viewport: {width: 900, height: 500}}), source = path.join(work, 'export.hdr');
    execFileSync(program, ['sky', '-o', source, '--height', '64', '--no-sun-disc', '--quiet']);
    await openFile(page, '/work/export.hdr', 'export.hdr');
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => (d.open = true)));
    await page.selectOption('#bake-size', '64');
    const engines = await page.evaluate(() => [...document.querySelector('#engine').options].map(option => option.value));
    for (const engine of all ? engines : ['unity']) {
        const folder = path.join(work, `export-${engine}`), expected = path.join(folder, 'expected'), found = path.join(folder, 'found');
        fs.rmSync(folder, {recursive: true, force: true});
        fs.mkdirSync(folder);
        const fixed = await page.evaluate(engine => ['godot', 'playcanvas'].includes(engine), engine), size = fixed ? [] : ['--size', '64'];
        await page.selectOption('#engine', engine);
        await page.selectOption('#bake-size', fixed ? '0' : '64');
        execFileSync(program, ['bake', source, '-o', expected, '--for', engine, ...size, '--quiet'], {stdio: ['ignore', 'pipe', 'pipe']});
        await page.getByRole('button', {name: 'Bake the files'}).click();
        const download = page.waitForEvent('download', {timeout: 120_000});
        await page.getByRole('button', {name: /^Save all as/}).click({timeout: 120_000});
        const saved = await download, archive = path.join(folder, saved.suggestedFilename());
        await saved.saveAs(archive);
        const wrong = saved.suggestedFilename() === `export-${engine}.zip` ? [] : [saved.suggestedFilename()];
        execFileSync('python3', ['-m', 'zipfile', '-e', archive, found]);
        const list = folder => fs.readdirSync(folder, {recursive: true}).sort().join(' ');
        if (list(found) !== list(expected)) wrong.push(`${list(found)}, not ${list(expected)}`);
        let different = 0, bytes = 0;
        for (const name of fs.readdirSync(expected).filter(name => /\.(ktx2|ktx|dds)$/.test(name) && fs.existsSync(path.join(found, name)))) {
            const a = fs.readFileSync(path.join(expected, name)), b = fs.readFileSync(path.join(found, name));
            // Filament's begin with the harmonics as text. Those for Bevy and three.js are packed, and may differ wholly after the first last bit.
            if (!['bevy', 'three', 'filament'].includes(engine) && a.length !== b.length) wrong.push(`${name} has ${b.length} bytes, not ${a.length}`);
            if (engine === 'filament' || a.length === b.length) for (let k = 1; k <= Math.min(a.length, b.length); ++k) different += a.at(-k) !== b.at(-k);
            bytes += a.length;
        }
        if (engine !== 'bevy' && engine !== 'three' && different > bytes / 200) wrong.push(`${different} of ${bytes} bytes differ`);
        claim(`export: the files for ${engine} are those of the program`, wrong, bytes ? `${different} of ${bytes} bytes of textures differ` : '');
    }
    claim('export: the console is silent', page.complaints);
    await page.close();
}

/// What was opened can be chosen again, beside what the page computes; light that is far too bright, or a file that is no lat-long map, is not the end.
async function testLists({open, claim, work, program}) {
    const run = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe']});
    run('sky', '-o', path.join(work, 'bright.hdr'), '--height', 64, '--no-sun-disc', '--quiet');
    run('sky', '-o', path.join(work, 'evening.hdr'), '--height', 64, '--no-sun-disc', '--sun-elevation-deg', 8, '--quiet');
    run('convert', path.join(work, 'evening.hdr'), '-o', path.join(work, 'round.hdr'), '--to', 'angular', '--size', 64, '--quiet');
    const page = await open('', {viewport: {width: 720, height: 400}}), named = async (what, name) => {
        await page.waitForFunction(name => domelight.ready && domelight.app.environmentName === name, name, {timeout: 20_000}).catch(() => {});
        const found = await page.evaluate(() => domelight.app.environmentName);
        claim(`lists: ${what}`, found === name ? [] : [`the page shows ${found}`]);
    };
    await openFile(page, '/work/bright.hdr', 'bright.hdr');
    const exposure = await state(page, 'exposure'), said = await page.locator('#notes .hint').last().textContent();
    claim('lists: under light that is far too bright the exposure is another, and the page says so', exposure < -3 && /is bright: the exposure is now -/.test(said) ? [] : [`${exposure}: ${said}`], `${exposure.toFixed(1)} EV`);
    await page.selectOption('#environment', 'studio');
    await named('the studio can be chosen after a file', 'studio');
    await page.waitForFunction(() => domelight.store.state.exposure === 0, undefined, {timeout: 10_000}).catch(() => {});
    claim('lists: its exposure is the usual one again', (await state(page, 'exposure')) === 0 ? [] : [`it is ${await state(page, 'exposure')}`]);
    await page.selectOption('#environment', 'bright.hdr');
    await named('and the file after the studio', 'bright.hdr');
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('n');
    await named('N goes on to the next', 'studio');
    await openFile(page, '/work/round.hdr', 'round.hdr');
    await named('a round map is refused where nobody says that it is one', 'studio');
    await setState(page, {projection: 'angular'});
    await named('it is read when its projection is chosen', 'round.hdr');
    await openFile(page, '/work/bright.hdr', 'teapot.obj');
    const model = await page.locator('#notes p').last().textContent();
    claim('lists: another kind of model gives a sentence', /teapot\.obj: models are read as \.glb or \.gltf/.test(model) ? [] : [model]);
    claim('lists: the console is silent', page.complaints);
    await page.close();
}

async function testLostContext({open, claim}) {
    const page = await open('#fullResolution=true', {viewport: {width: 400, height: 240}});
    const middle = () => page.evaluate(async () => {
        const {width, height} = domelight.stage.panes[0], values = new Float32Array(4);
        await domelight.paneAt(2, 0);
        domelight.stage.renderer.readRenderTargetPixels(domelight.stage.panes[0].target, width >> 1, height >> 1, 1, 1, values);
        return [...values];
    });
    await setState(page, {turn: 1});
    const before = await middle();
    await page.evaluate(async () => {
        const lose = domelight.stage.renderer.getContext().getExtension('WEBGL_lose_context');
        lose.loseContext();
        await new Promise(done => setTimeout(done, 300));
        lose.restoreContext();
        await new Promise(done => setTimeout(done, 300));
    });
    const after = await middle();
    claim('lost context: the picture comes back', Math.max(...before.map((v, k) => Math.abs(v - after[k]))) < 1e-3 && before[0] > 0 ? [] : [`${before} became ${after}`]);
    await page.close();
}

async function testPhone({open, claim, work}) {
    const page = await open('', {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true});
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    claim('phone: nothing is wider than the screen', wide <= 390 ? [] : [`the page is ${wide} wide`]);
    claim('phone: the panel is folded', (await state(page, 'panel')) ? ['it is open'] : []);
    await page.tap('#unfold');
    await settle(page);
    await page.waitForTimeout(300);
    const box = await page.locator('#panel').boundingBox();
    claim('phone: the panel opens over the lower half', box && box.y > 380 && box.y + box.height <= 845 ? [] : [JSON.stringify(box)]);
    await page.screenshot({path: path.join(work, 'phone.png')});
    claim('phone: the console is silent', page.complaints);
    await page.close();
}

async function testAccessibility({open, claim, root, work}) {
    const axe = fs.readFileSync(path.join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8');
    const page = await open('#mode=monte-carlo&view=split&other=phong', {viewport: {width: 1000, height: 600}}), schemes = ['light', 'dark'];
    await page.evaluate(axe);
    const check = async what => {
        for (const colorScheme of schemes) {
            await page.emulateMedia({colorScheme});
            const found = await page.evaluate(() => axe.run(document, {resultTypes: ['violations']}));
            claim(`accessibility: ${what}, ${colorScheme}: axe-core finds nothing`, found.violations.map(v => `${v.id}: ${v.help} (${v.nodes.map(n => n.target).slice(0, 3).join(' ')})`));
        }
    };
    await check('the page');
    await page.evaluate(() => document.querySelectorAll('details').forEach(d => (d.open = true)));
    await setState(page, {override: true});
    await check('all sections open');
    await page.evaluate(() => domelight.app.events.failed('A sentence.'));
    await check('a sentence shown');
    await page.keyboard.press('?');
    await check('the help');
    await page.keyboard.press('Escape');
    for (const colorScheme of schemes) {
        await page.emulateMedia({colorScheme});
        await page.screenshot({path: path.join(work, `page-${colorScheme}.png`)});
    }
    await page.close();
}

async function testTab({open, claim}) {
    const page = await open('', {viewport: {width: 900, height: 500}});
    const reached = new Set();
    for (let k = 0; k < 60; ++k) {
        await page.keyboard.press('Tab');
        reached.add(await page.evaluate(() => document.activeElement?.textContent?.slice(0, 12) + document.activeElement?.tagName + (document.activeElement?.value ?? '')));
    }
    const focusable = await page.evaluate(() => [...document.querySelectorAll('#panel button, #panel select, #panel input[type=range], #panel input[type=checkbox], #panel summary')]
        .filter(e => e.checkVisibility()).map(e => e.textContent.slice(0, 12) + e.tagName + (e.value ?? '')));
    claim('keyboard: Tab reaches every control of the panel', focusable.filter(name => !reached.has(name)));
    await page.close();
}

export async function testInterface(app) {
    for (const test of [testStart, testKeys, testView, testAddress, testBadFiles, testModels, testProjections, testFlip, testExport, testLists, testLive, testLostContext, testPhone, testAccessibility, testTab]) {
        const start = performance.now();
        try {
            await test(app);
            console.log(`${test.name}: ${((performance.now() - start) / 1000).toFixed(1)} s`);
        } catch (error) {
            app.claim(`${test.name} runs`, [error.stack]);
        }
    }
}
