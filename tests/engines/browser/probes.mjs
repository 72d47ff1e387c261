// Engines load the light of many probes, and their pictures of a matte room are compared with our own from the same set.

import fs from 'node:fs';
import path from 'node:path';
import {call, draw, open} from './browser.mjs';
import {onScreen, readHdr} from './files.mjs';
import {roomScene, writeRoom} from './room.mjs';

/// RMS difference of two pictures as a screen shows them (sRGB's curve, clipped at 1), in steps of 1/255.
function screenError(a, b) {
    let sum = 0, count = 0;
    for (let k = 0; k < a.rgba.length; k += 4)
        for (let c = 0; c < 3; ++c, ++count) sum += (onScreen(a.rgba[k + c]) - onScreen(b.rgba[k + c])) ** 2;
    return 255 * Math.sqrt(sum / count);
}

/// A picture whose pixels are the means of `n` x `n` of a larger one: Domelight's are means over a pixel's area.
function reduced(picture, n) {
    const width = picture.width / n, height = picture.height / n, rgba = new Float32Array(4 * width * height);
    for (let k = 0; k < picture.rgba.length; ++k) {
        const pixel = k >> 2, x = Math.floor(pixel % picture.width / n), y = Math.floor(pixel / picture.width / n);
        rgba[4 * (y * width + x) + k % 4] += picture.rgba[k] / n ** 2;
    }
    return {width, height, rgba};
}

/// `tools`: {claim, domelight, work, browser, server, log, keep}.
export async function testProbes({claim, domelight, work, browser, server, log, keep}) {
    writeRoom(work);
    const {file, width, height, fovDeg, eye, target} = roomScene, scene = path.join(work, file), sky = path.join(work, 'sky.hdr');
    const light = ['--env', sky, '--exposure', 1.3];
    const set = (name, ...more) => {
        domelight('probes', scene, ...light, '-o', path.join(work, name), '--spp', 16, '--size', 32, '--quiet', ...more);
        return path.join(work, name);
    };
    const ours = (name, probes, ...more) => {
        const picture = path.join(work, `${name}.hdr`);
        domelight('render', scene, ...light, '--probes', probes, '--shading', 'split-sum', '--irradiance', 'sh', '--probe-visibility', 'off',
                  '--background', 'transparent', '--occlusion', 'off', '--width', width, '--height', height, '--camera-position', eye.join(),
                  '--camera-target', target.join(), '--fov-deg', fovDeg, '--spp', 16, '--quiet', '-o', picture, ...more);
        const {rgb} = readHdr(picture), rgba = new Float32Array(4 * width * height);
        for (let k = 0; k < width * height; ++k) rgba.set(rgb.subarray(3 * k, 3 * k + 3), 4 * k);
        keep(name, {width, height, rgba});
        return {width, height, rgba};
    };
    const engine = async (name, page, load) => {
        await call(page, ...load);
        const picture = reduced(await draw(page, {model: `/files/${file}`, eye, target, fovDeg, width: 4 * width, height: 4 * height}), 4);
        keep(name, picture);
        await page.close();
        return picture;
    };
    const compare = (what, theirs, mine) => {
        const error = screenError(theirs, mine);
        claim(what, error <= 2 ? [] : [`it differs by ${error.toFixed(2)} of 255`], `${error.toFixed(2)} of 255 RMS`);
    };

    const grid = set('grid', '--grid', '4,2,3', '--for', 'three');
    const three = await engine('three-probes', await open(browser, server.url, 'three', log), ['loadProbes', '/files/grid/three/light-probe-grid.json']);
    compare('three: LightProbeGrid lights a room as our own renderer does from the same probes', three, ours('three-probes-ours', grid, '--probe-offset', 0.5));

    const one = set('one', '--at', '0,1.2,0.3', '--for', 'babylon');
    const babylon = await engine('babylon-probe', await open(browser, server.url, 'babylon', log), ['load', {probes: '/files/one/babylon/probes.json'}]);
    const lit = ours('babylon-probe-ours', one);
    compare('babylon: a local probe lights a room as our own renderer does from the same probe', babylon, lit);
    const righthanded = await engine('babylon-probe-righthanded', await open(browser, server.url, 'babylon', log),
                                     ['load', {probes: '/files/one/babylon/probes.json', rightHanded: true}]);
    compare('babylon: the same in a right-handed world', righthanded, lit);
    fs.rmSync(path.join(work, file));
}
