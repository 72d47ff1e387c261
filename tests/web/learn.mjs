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
};

async function testAxe(page, axe, what, claim) {
    await page.evaluate(axe);
    const violations = await page.evaluate(async () => (await window.axe.run(document)).violations.map(v => `${v.id}: ${v.nodes.map(n => n.target.join(' ')).slice(0, 3).join(', ')}`));
    claim(`${what}: axe finds nothing`, violations);
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
        await page.setViewportSize({width: 390, height: 844});
        const beyond = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        claim(`${name}: it fits a phone`, beyond > 0 ? [`${beyond} pixels stand out to the right`] : []);
        claim(`${name}: the console is silent`, page.complaints);
        await page.close();
    }
}
