// The pages that teach: each opens in silence, draws, is read by a screen reader, fits a phone, and its numbers are right.

import fs from 'node:fs';
import path from 'node:path';

/// Sets a slider by its label, as the keyboard does, and waits until the figures show it.
async function slide(page, label, value) {
    await page.getByLabel(label, {exact: true}).evaluate((input, v) => {
        input.value = v;
        input.dispatchEvent(new Event('input', {bubbles: true}));
    }, String(value));
    await settled(page);
}

async function settled(page) {
    await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
    await page.waitForFunction(() => lesson.ready, undefined, {timeout: 30_000});
}

const numbers = page => page.evaluate(() => ({...lesson.numbers}));
const near = (what, value, expected, tolerance) => (Math.abs(value - expected) <= tolerance ? [] : [`${what} is ${value}, not ${expected}`]);

/// Of each page: a slider that changes its main number, and claims about its numbers.
const lessons = {
    projections: {
        slider: ['Direction: elevation', -10], number: 'v0',
        check: async (page, claim) => {
            await slide(page, 'Direction: azimuth', 90);
            await slide(page, 'Direction: elevation', 30);
            // d = (0, 1/2, √3/2): the sphere map has p = d.xy / √(2 (1 + z)), the paraboloid d.xy / (1 + z), the octahedron (x, z) / Σ|.|
            const n = await numbers(page), z = Math.sqrt(3) / 2, points = {0: [0.75, 1 / 3], 1: [(1 + 0.5) / 3, (1 + 0.5 - 0.25 / z) / 2], 2: [0.5, 0.5 - 0.25 / Math.sqrt(2 * (1 + z))],
                                                                           3: [0.25, 0.5 - 0.25 / (1 + z)], 4: [0.5, 0.5 - (0.5 * z) / (0.5 + z)]};
            claim('projections: the five points are those of the formulas', Object.entries(points).flatMap(([k, [u, v]]) => [...near(`u of ${k}`, n[`u${k}`], u, 1e-4), ...near(`v of ${k}`, n[`v${k}`], v, 1e-4)]));
            claim('projections: a lat-long texel covers 2π² sin θ, one of a sphere map 4π over the disc', [...near('lat-long', n.spread0, (Math.PI / 2) * z, 1e-3), ...near('sphere map', n.spread2, 4 / Math.PI, 2e-3)]);
            const box = await page.getByRole('img', {name: /^Lat-long/}).boundingBox();
            await page.mouse.move(box.x + 0.25 * box.width, box.y + 0.5 * box.height);
            await settled(page);
            const {u0, v0} = await numbers(page);
            claim('projections: the direction is that under the pointer', [...near('u', u0, 0.25, 0.004), ...near('v', v0, 0.5, 0.008)]);
        },
    },
    irradiance: {
        slider: ['J: steps of θ', 9], number: 'sum',
        check: async (page, claim) => {
            await slide(page, 'K: steps of φ', 256);
            await slide(page, 'J: steps of θ', 64);
            const {sum, exact, error} = await numbers(page);
            claim('irradiance: the sum of 256 x 64 terms is the library\'s exact value, within 0.3 %', near('the ratio', sum / exact, 1, 0.003), `${(100 * error).toFixed(2)} %`);
            await page.getByRole('combobox', {name: 'Environment'}).selectOption('furnace');
            await settled(page);
            await slide(page, 'J: steps of θ', 4);
            // π²/4 Σ cos θ sin θ at the four middles is 3.2237.
            const even = await numbers(page);
            claim('irradiance: an even light has E = π, and the sum of J = 4 is 3.2237', [...near('E', even.exact, Math.PI, 1e-5), ...near('the sum', even.sum, 3.22365, 1e-4)]);
        },
    },
    phong: {
        slider: ['Exponent', 7], number: 'level',
        check: async (page, claim) => {
            // 128 is the exponent of level 3: the chain has it without a mix.
            const at = await numbers(page);
            claim('phong: at the exponent of a level, the level has the exact light', [...near('the level', at.level, 3, 1e-6), ...near('the ratio', at.light / at.exact, 1, 0.02)], `${(100 * (at.light / at.exact - 1)).toFixed(2)} %`);
            await slide(page, 'Exponent', 8);
            const between = await numbers(page);
            claim('phong: between two levels the exact light is that of the exponent', between.exact !== at.exact && Math.abs(between.light / between.exact - 1) < 0.2 ? [] : [`${between.light}, exactly ${between.exact}`]);
            await slide(page, 'Exponent', 0);
            const below = await numbers(page);
            claim('phong: below the last level it is mixed with the irradiance', near('the ratio', below.light / below.exact, 1, 0.05), `${(100 * (below.light / below.exact - 1)).toFixed(2)} %`);
        },
    },
    'split-sum': {
        slider: ['Point: n · v', 0.1], number: 'split',
        check: async (page, claim) => {
            const coarse = await numbers(page);
            await slide(page, 'N: samples of the table', 512);
            const fine = await numbers(page);
            claim('split-sum: the sampled table converges to the library\'s', fine.tableError < 0.01 && fine.tableError < 0.5 * coarse.tableError ? [] : [`the RMS error was ${coarse.tableError} and is ${fine.tableError}`], `${fine.tableError.toFixed(4)}`);
            claim('split-sum: at a grazing angle it is off by more than 10 %', Math.abs(fine.split / fine.truth - 1) > 0.1 && fine.truthError < 0.01 * fine.truth ? [] : [`${fine.split} for ${fine.truth}`], `${(100 * (fine.split / fine.truth - 1)).toFixed(0)} %`);
            await page.getByRole('combobox', {name: 'Environment'}).selectOption('furnace');
            await settled(page);
            const even = await numbers(page);
            claim('split-sum: in an even light it is exact', near('the ratio', even.split / even.truth, 1, 0.002 + (4 * even.truthError) / even.truth));
        },
    },
    importance: {
        slider: ['v: which row', 0.5], number: 'row',
        check: async (page, claim) => {
            const {error, exact} = await numbers(page);
            claim('importance: 512 samples of the shader\'s loops give the exact diffuse light, within 1 %', exact > 0 && error < 0.01 ? [] : [`the error is ${error}`], `${(100 * error).toFixed(2)} %`);
            const wrong = await page.evaluate(() => {
                const {rows, columns, width, height} = lesson.light.tables, {row, column, density} = lesson.numbers, {u, v} = lesson.state;
                const found = [...Array(height).keys()].find(j => rows[2 * j] > v), place = [...Array(width).keys()].find(i => columns[2 * (row * width + i)] > u);
                const share = (rows[2 * row] - rows[2 * row - 2]) * (columns[2 * (row * width + column)] - columns[2 * (row * width + column) - 2]);
                const over = (density * 2 * Math.PI ** 2 * Math.sin((Math.PI * (row + 0.5)) / height)) / (share * width * height) - 1;
                return [found !== row && `the row is ${row}, by its cumulative function ${found}`, place !== column && `the column is ${column}, by its cumulative function ${place}`,
                        Math.abs(over) > 0.02 && `the density is off by ${over}`].filter(Boolean);
            });
            claim('importance: the loops find the texel of the cumulative functions, with its density', wrong);
        },
    },
    mis: {
        slider: ['Roughness', 0.05], number: 'environment',
        check: async (page, claim) => {
            const smooth = await numbers(page);
            await slide(page, 'Roughness', 0.5);
            const middle = await numbers(page);
            const apart = ['brdf', 'environment'].flatMap(key => near(`the mean by ${key}`, middle[`${key}Mean`], middle.bothMean, 4.5 * Math.hypot(middle[`${key}Error`], middle.bothError)));
            claim('mis: all strategies have one mean', apart);
            claim('mis: pixels scatter as the integrals of the noise say', ['brdf', 'both'].flatMap(key => near(`the ratio by ${key}`, middle[`${key}Measured`] / middle[key], 1, 0.2)), ['brdf', 'environment', 'both'].map(key => (middle[`${key}Measured`] / middle[key]).toFixed(2)).join(', '));
            await slide(page, 'Roughness', 1);
            const rough = await numbers(page);
            claim('mis: both together are never far from the better one',
                  [smooth, rough].filter(n => !(n.both < 2 * Math.min(n.brdf, n.environment))).map(n => `both ${n.both}, BRDF ${n.brdf}, environment ${n.environment}`),
                  [smooth, rough].map(n => `BRDF ${n.brdf.toFixed(2)}, environment ${n.environment.toFixed(2)}, both ${n.both.toFixed(2)}`).join('; '));
            await slide(page, 'Roughness', 0.3);
            await page.getByRole('combobox', {name: 'Environment'}).selectOption('sunset');
            await settled(page);
            const sun = await numbers(page);
            claim('mis: a sun that the BRDF hardly ever finds is in its noise', sun.brdf > 2 * sun.both && sun.brdfMean < sun.bothMean ? [] : [`BRDF ${sun.brdf}, both ${sun.both}; means ${sun.brdfMean}, ${sun.bothMean}`],
                  `${sun.brdf.toFixed(1)}, of ${sun.brdfMeasured.toFixed(1)} in 512 pixels; both ${sun.both.toFixed(1)}`);
        },
    },
    probes: {
        slider: ['Point: x', 3.3], number: 'probes',
        check: async (page, claim) => {
            const n = await numbers(page), eight = [...Array(8).keys()], total = eight.reduce((sum, k) => sum + n[`product${k}`], 0);
            claim('probes: each weight is the product of its factors over the sum of all eight', [...near('the sum of the weights', n.sum, 1, 1e-4), ...near('that of t', n.trilinear, 1, 1e-4),
                  ...eight.flatMap(k => near(`weight ${k}`, n[`weight${k}`], n[`product${k}`] / total, 1e-3))]);
            claim('probes: with visibility, the dark room is as dark as it is', n.ratio > 0.8 && n.ratio < 1.25 ? [] : [`the light is ${n.ratio} of the truth`], n.ratio.toFixed(3));
            await page.getByLabel('Visibility', {exact: true}).uncheck();
            await settled(page);
            const leak = await numbers(page);
            claim('probes: without it, light leaks through the wall', leak.ratio > 3 ? [] : [`the light is ${leak.ratio} of the truth`], `${leak.ratio.toFixed(1)} of the truth`);
            claim('probes: then the weights are trilinear', eight.flatMap(k => near(`weight ${k}`, leak[`weight${k}`], leak[`t${k}`], 1e-3)));
        },
    },
};

async function testAxe(page, axe, what, claim) {
    await page.evaluate(axe);
    const violations = [];
    for (const colorScheme of ['light', 'dark']) {
        await page.emulateMedia({colorScheme});
        violations.push(...await page.evaluate(async scheme => (await window.axe.run(document)).violations.map(v => `${scheme}: ${v.id}: ${v.nodes.map(n => n.target.join(' ')).slice(0, 3).join(', ')}`), colorScheme));
    }
    claim(`${what}: axe finds nothing, in light and dark`, violations);
}

/// A .hdr of an even light of radiance 2, and a file that is none.
async function testFiles(page, claim) {
    const width = 64, height = 32, texels = Buffer.alloc(4 * width * height);
    for (let k = 0; k < texels.length; k += 4) texels.set([128, 128, 128, 130], k);
    const header = Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
    const choose = (name, buffer) => page.setInputFiles('input[type=file]', {name, mimeType: 'image/vnd.radiance', buffer});
    await choose('even.hdr', Buffer.concat([header, texels]));
    await page.waitForFunction(() => lesson.light.name === 'even.hdr' && lesson.ready, undefined, {timeout: 30_000});
    const {exact} = await numbers(page);
    claim('learn: a file of the user\'s lights the page', near('E', exact, 2 * Math.PI, 1e-3));
    await choose('broken.hdr', Buffer.from('this is not a picture'));
    await page.waitForSelector('#notes p');
    const {light, sentence} = await page.evaluate(() => ({light: lesson.light.name, sentence: document.querySelector('#notes p').textContent}));
    claim('learn: a broken file gives a sentence, and the light stays', light === 'even.hdr' && sentence.startsWith('broken.hdr') ? [] : [`${light}: ${sentence}`]);
    const select = async (option, name) => {
        await page.getByRole('combobox', {name: 'Environment'}).selectOption(option);
        return page.waitForFunction(name => lesson.light.name === name && lesson.ready, name, {timeout: 30_000});
    };
    await select('studio', 'studio');
    claim('learn: the file can be chosen again', await select('file', 'even.hdr').then(() => [], error => [String(error)]));
    await select('studio', 'studio');
}

/// The graphics context is lost and comes back.
async function testLostContext(page, claim) {
    const before = await numbers(page);
    await page.evaluate(async () => {
        const lose = lesson.painter.renderer.getContext().getExtension('WEBGL_lose_context'), pause = () => new Promise(done => setTimeout(done, 200));
        lose.loseContext();
        await pause();
        lesson.values.set({j: lesson.state.j + 3});
        await pause();
        lose.restoreContext();
        await pause();
    });
    await settled(page);
    const between = await numbers(page);
    await page.evaluate(() => lesson.values.set({j: lesson.state.j - 3}));
    await settled(page);
    const after = await numbers(page);
    claim('learn: after a lost context the figures are computed again', between.sum !== before.sum && after.sum === before.sum ? [] : [`${before.sum}, ${between.sum}, ${after.sum}`]);
    page.complaints = page.complaints.filter(text => !/context/i.test(text));
}

/// The parts that all pages share: titles, icons, and the links from one page to the next and back.
async function testFrame(page, server, links, claim) {
    const wrong = await page.evaluate(async ([app, links]) => {
        const wrong = [], at = (href, base) => new URL(href, base).href, pages = ['index.html', 'learn/index.html', ...links.map(link => `learn/${link}`)].map(name => at(name, app));
        const read = async url => new DOMParser().parseFromString(await (await fetch(url)).text(), 'text/html');
        for (const [k, url] of pages.entries()) {
            const text = await read(url), href = selector => text.querySelector(selector)?.getAttribute('href'), heading = text.querySelector('h1').textContent;
            const say = (what, right) => right || wrong.push(`${url.replace(app, '')}: ${what}`);
            say('title', text.title === (k ? `${heading} – Domelight` : 'Domelight'));
            say('description', text.querySelector('meta[name=description]')?.content.length > 20);
            say('charset within the first kilobyte', text.head.firstElementChild.getAttribute('charset') === 'utf-8');
            const icon = await fetch(at(href('link[rel=icon]'), url));
            say('icon', icon.ok && icon.headers.get('content-type') === 'image/svg+xml');
            for (const a of text.querySelectorAll('a')) say(`link to ${a.getAttribute('href')}`, pages.includes(at(a.getAttribute('href'), url)));
            if (k < 2) continue;
            for (const [rel, to] of [['prev', pages[k - 1]], ['next', pages[k + 1]]]) {
                const there = k + (rel === 'next' ? 1 : -1) > 1 ? to : undefined, found = href(`a[rel=${rel}]`);
                say(`the ${rel} page`, (found && at(found, url)) === there);
            }
        }
        return wrong;
    }, [`${server.url}/app/`, links]);
    claim('learn: every page has its title and an icon, and leads to its neighbours', wrong);
}

export async function testLearn({root, server, browser, claim, watch}) {
    const axe = fs.readFileSync(path.join(root, 'web/node_modules/axe-core/axe.min.js'), 'utf8');
    const open = async (name, options = {}) => {
        const page = watch(await browser.newPage({viewport: {width: 1100, height: 800}, ...options}));
        await page.goto(`${server.url}/app/learn/${name}index.html`);
        return page;
    };
    const list = await open('');
    const links = await list.locator('#pages a').evaluateAll(all => all.map(a => a.getAttribute('href')));
    claim('learn: the list has every page, and only those', [...links.filter(link => !lessons[link.split('/')[0]]), ...Object.keys(lessons).filter(name => !links.includes(`${name}/index.html`))]);
    await testFrame(list, server, links, claim);
    await testAxe(list, axe, 'learn', claim);
    await list.close();
    for (const [name, {slider: [label, value], number, check}] of Object.entries(lessons)) {
        const page = await open(`${name}/`);
        await page.waitForFunction(() => window.lesson?.ready, undefined, {timeout: 30_000});
        const before = await numbers(page);
        await slide(page, label, value);
        const after = await numbers(page);
        claim(`${name}: "${label}" changes the number of the page`, Number.isFinite(after[number]) && after[number] !== before[number] ? [] : [`${number} was ${before[number]} and is ${after[number]}`]);
        await testAxe(page, axe, name, claim);
        await check(page, claim);
        if (name === 'irradiance') {
            await testFiles(page, claim);
            await testLostContext(page, claim);
        }
        await page.setViewportSize({width: 390, height: 844});
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        claim(`${name}: it fits a phone`, beyond > 0 ? [`${beyond} pixels stand out to the right`] : []);
        claim(`${name}: the console is silent`, page.complaints);
        await page.close();
    }
}
