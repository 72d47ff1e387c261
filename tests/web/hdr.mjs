// Highlights brighter than white, on a canvas of WebGPU: against the ordinary picture and against the formulas of docs/app.md.

import {setState} from './frames.mjs';

/// The page believes that its screen shows more than white.
const brightScreen = () => {
    const ask = window.matchMedia.bind(window);
    window.matchMedia = query => (query === '(dynamic-range: high)' ? Object.assign(new EventTarget(), {matches: true, media: query}) : ask(query));
};

const encode = v => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const decode = e => (e <= 0.04045 ? e / 12.92 : ((e + 0.055) / 1.055) ** 2.4);
const reinhard = rgb => {
    const l = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    return rgb.map(v => (v * (1 + l / 16)) / (1 + l));
};
const knees = {aces: 1.97, agx: 2.74, neutral: 0.86};
/// How many times as bright as on an ordinary screen.
const gain = (radiance, knee, peak) => {
    const t = Math.max(0, radiance / knee - 1) / (peak - 1);
    return 1 + ((peak - 1) * t * t) / (1 + t + t * t);
};

/// The same picture: radiance, the bytes of an ordinary screen, and the values of the HDR canvas; RGB, RGBA, RGBA, rows from the top.
const pictures = page => page.evaluate(async () => {
    const {stage, app} = domelight;
    await domelight.paneAt(2, 0);
    app.redraw = () => {};  // the picture stays as it is from here on
    await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
    const {target} = stage.panes[0], {width, height} = target, upside = new Float32Array(4 * width * height), radiance = [];
    await stage.renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, upside);
    for (let y = height - 1; y >= 0; --y) radiance.push(...upside.subarray(4 * y * width, 4 * (y + 1) * width));
    stage.show(app.state);
    const {screen} = stage.extended, {device} = screen, texture = screen.context.getCurrentTexture(), row = Math.ceil((8 * width) / 256) * 256;
    const buffer = device.createBuffer({size: row * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ}), encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({texture}, {buffer, bytesPerRow: row}, [width, height]);
    device.queue.submit([encoder.finish()]);
    await buffer.mapAsync(GPUMapMode.READ);
    const halves = new Float16Array(buffer.getMappedRange()), hdr = [];
    for (let y = 0; y < height; ++y) hdr.push(...halves.subarray((y * row) / 2, (y * row) / 2 + 4 * width));
    stage.showWhite(app.state);
    const drawn = stage.renderer.domElement, copy = new OffscreenCanvas(width, height).getContext('2d');
    copy.drawImage(drawn, 0, 0);
    delete app.redraw;
    return {width, height, radiance, hdr, sdr: [...copy.getImageData(0, 0, width, height).data], size: [drawn.width, drawn.height], mode: screen.context.getConfiguration().toneMapping.mode};
});

/// The largest departure from the formula, in values of the display; how many channels are above white; the largest value.
function measure({radiance, sdr, hdr}, tonemap, exposure, peak) {
    let wrong = 0, unlike = 0, above = 0, most = 0;
    for (let k = 0; k < hdr.length; k += 4) {
        const rgb = radiance.slice(k, k + 3).map(v => v * exposure), brightest = Math.max(...rgb);
        const exact = tonemap === 'none' ? rgb : tonemap === 'reinhard' ? reinhard(rgb) : null;
        for (let c = 0; c < 3; ++c) {
            const shown = hdr[k + c], plain = sdr[k + c] / 255;
            above += shown > 1;
            most = Math.max(most, shown);
            // Half a byte of the ordinary picture is all that is known of it; then the rounding of halves, 2^-11 of the value.
            if (exact ? Math.max(...exact) < 1 : brightest < knees[tonemap]) unlike = Math.max(unlike, Math.abs(shown - plain));
            const expected = exact ? encode(Math.min(peak, exact[c])) : encode(decode(plain) * gain(brightest, knees[tonemap], peak));
            wrong = Math.max(wrong, Math.abs(shown - expected) / Math.max(1, expected));
        }
    }
    return {wrong, unlike, above, most};
}

export async function testHdr({withWebGpu, open, claim}) {
    const browser = await withWebGpu(), size = {viewport: {width: 320, height: 160}};
    const page = await open('#panel=false&fullResolution=true&exposure=1&peak=3&tonemap=none', size, brightScreen, browser);
    const said = page => page.evaluate(() => [...document.querySelectorAll('#status, #panel .note')].map(part => part.textContent).filter(text => /HDR|SDR/.test(text)).join(' | '));
    await page.waitForFunction(() => domelight.app.dynamicRange === 'HDR' && domelight.ready, undefined, {timeout: 20_000});
    const words = await said(page);
    claim('HDR: the page says so', /HDR: 1 is the white/.test(words) && !/SDR/.test(words) ? [] : [words]);
    for (const tonemap of ['none', 'reinhard', 'aces', 'agx', 'neutral']) {
        await setState(page, {tonemap});
        const found = await pictures(page), {wrong, unlike, above, most} = measure(found, tonemap, 2, 3), problems = [];
        if (found.mode !== 'extended') problems.push(`tone mapping is ${found.mode}`);
        if (unlike > 0.5 / 255 + 2 ** -11) problems.push(`below the knee a value differs from the ordinary picture by ${255 * unlike} of 255`);
        if (wrong > (tonemap === 'none' || tonemap === 'reinhard' ? 2 ** -10 : 1 / 255)) problems.push(`a value differs from the formula by ${255 * wrong} of 255`);
        if (above < 100 || most > encode(3) + 2 ** -9 || most < 1.1) problems.push(`${above} values are above white, the largest is ${most}`);
        claim(`HDR: by ${tonemap} highlights are brighter than white, and what is below the knee is as before`, problems, `${above} values above 1, at most ${most.toFixed(2)}`);
    }
    await setState(page, {hdr: false});
    await page.waitForFunction(() => domelight.app.dynamicRange === 'SDR', undefined, {timeout: 20_000});
    const off = await page.evaluate(() => [domelight.app.dynamicRange, document.querySelectorAll('canvas.hdr').length, domelight.stage.renderer.domElement.height]);
    claim('HDR: switched off, the canvas of WebGL2 shows the picture', String(off) === 'SDR,0,160' ? [] : [String(off)]);
    await setState(page, {hdr: true});
    await page.waitForFunction(() => domelight.app.dynamicRange === 'HDR', undefined, {timeout: 20_000});
    await page.evaluate(() => domelight.stage.extended.screen.device.destroy());
    await page.waitForFunction(() => domelight.app.dynamicRange === 'SDR', undefined, {timeout: 20_000});
    claim('HDR: where the graphics card is lost, the page says that it shows SDR', /was lost/.test(await said(page)) ? [] : [await said(page)]);
    claim('HDR: the console is silent', page.complaints);
    await page.close();
    await browser.close();

    const plain = await open('', size);
    claim('HDR: on an ordinary screen the page says that it shows SDR', /SDR: this screen/.test(await said(plain)) ? [] : [await said(plain)]);
    await plain.close();
}
