// What is drawn over the environment's map: samples, density, the lobe under the pointer, and the error of nine harmonics.

/// The pixels of the map: width, height, and RGBA rows from the top.
const mapPixels = page => page.evaluate(async () => {
    await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
    const canvas = document.querySelector('canvas[aria-label^="The environment as a lat-long map"]'), {width, height} = canvas;
    const copy = new OffscreenCanvas(width, height).getContext('2d');
    copy.drawImage(canvas, 0, 0);
    return {width, height, data: [...copy.getImageData(0, 0, width, height).data]};
});
const luma = ({data}, k) => 0.2126 * data[4 * k] + 0.7152 * data[4 * k + 1] + 0.0722 * data[4 * k + 2];
const mean = values => values.reduce((a, v) => a + v, 0) / values.length;

export async function testOverlays({open, claim}) {
    const page = await open('#fullResolution=true', {viewport: {width: 900, height: 500}});
    const section = page.locator('details', {has: page.locator('summary', {hasText: 'Environment map'})});
    await section.evaluate(details => (details.open = true));
    await section.locator('.note', {hasText: 'Luminance in EV'}).waitFor();
    const toggle = name => section.getByRole('button', {name, exact: true}).click();
    const plain = await mapPixels(page), count = plain.width * plain.height, all = [...Array(count).keys()];
    /// Switches an overlay on, waits until `drawn` finds it in the map, and switches it off.
    const withOverlay = async (name, drawn = picture => all.some(k => Math.abs(luma(picture, k) - luma(plain, k)) > 20)) => {
        await toggle(name);
        let picture = await mapPixels(page);
        for (let tries = 0; tries < 50 && !drawn(picture); ++tries) {
            await page.waitForTimeout(100);
            picture = await mapPixels(page);
        }
        await toggle(name);
        return picture;
    };

    const pink = picture => all.filter(k => picture.data[4 * k] > 200 && picture.data[4 * k + 1] < 140 && picture.data[4 * k + 2] > 170);
    const found = pink(await withOverlay('Samples', picture => pink(picture).length > 50)), lit = mean(found.map(k => luma(plain, k))), usual = mean(all.map(k => luma(plain, k)));
    claim('overlays: samples lie where the light is', found.length > 50 && lit > usual + 40 ? [] : [`${found.length} pixels, whose brightness is ${lit} where the mean is ${usual}`], `${lit.toFixed(0)} of 255, the mean is ${usual.toFixed(0)}`);

    const density = await withOverlay('Density'), sorted = [...all].sort((a, b) => luma(plain, a) - luma(plain, b)), twentieth = Math.floor(count / 20);
    const [dark, bright] = [sorted.slice(0, twentieth), sorted.slice(-twentieth)].map(pixels => mean(pixels.map(k => luma(density, k))));
    claim('overlays: the density rises with the light', bright > dark + 20 ? [] : [`${dark} where it is dark, ${bright} where it is bright`]);

    // Of a ball that is neither smooth nor rough: where it faces the eye, and the direction that is mirrored there.
    await toggle('Lobe');
    const {x, y, direction} = await page.evaluate(() => {
        const {eye} = domelight.store.state, unit = v => v.map(c => c / Math.hypot(...v)), dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
        let best = {facing: -1};
        for (let y = 4; y < innerHeight; y += 4)
            for (let x = 4; x < innerWidth; x += 4) {
                const point = document.elementFromPoint(x, y).tagName === 'CANVAS' && domelight.stage.surfaceAt(x / innerWidth, y / innerHeight)?.toArray();
                if (!point || Math.round(point[0]) !== -1 || point[1] < 0) continue;
                const n = unit([point[0] + 1, point[1] - 0.5, point[2]]), v = unit(eye.map((c, k) => c - point[k])), facing = dot(n, v);
                if (facing > best.facing) best = {facing, x, y, direction: n.map((c, k) => 2 * facing * c - v[k])};
            }
        return best;
    });
    const part = (picture, k) => (picture.data[4 * k + 1] - plain.data[4 * k + 1]) / (256 - plain.data[4 * k + 1]);
    let angle = Infinity;
    for (let tries = 0; tries < 30 && !(angle < 10); ++tries) {
        await page.mouse.move(x + (tries % 2), y);
        await page.waitForTimeout(100);
        const picture = await mapPixels(page), k = all.reduce((best, k) => (part(picture, k) > part(picture, best) ? k : best), 0);
        const phi = (((k % plain.width) + 0.5) / plain.width - 0.5) * 2 * Math.PI, theta = ((Math.floor(k / plain.width) + 0.5) / plain.height) * Math.PI;
        const cosine = Math.sin(theta) * Math.cos(phi) * direction[0] + Math.cos(theta) * direction[1] + Math.sin(theta) * Math.sin(phi) * direction[2];
        angle = (Math.acos(Math.min(1, cosine)) * 180) / Math.PI;
    }
    claim('overlays: the lobe lies about the mirror direction', angle < 10 ? [] : [`its middle is ${angle.toFixed(0)}° away`], `${angle.toFixed(0)}°`);
    await toggle('Lobe');

    await withOverlay('SH');
    await toggle('SH');
    const text = await section.locator('.note', {hasText: 'Nine harmonics'}).textContent(), [rms, most] = [...text.matchAll(/([\d.]+) %/g)].map(([, v]) => Number(v));
    claim('overlays: the error of nine harmonics is told', rms > 0 && most > rms && most < 100 ? [] : [text], text);
    claim('overlays: the console is silent', page.complaints);
    await page.close();
}
