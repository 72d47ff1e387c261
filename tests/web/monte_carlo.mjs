// Live Monte Carlo against the path tracer's direct light without shadows: each ball's mean lies within the interval that the samples themselves state.

import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {readHdr} from '../engines/browser/files.mjs';
import {openFile, readPane, setState} from './frames.mjs';

const width = 280, height = 140, half = 16;
const columns = 7, unit = width / 7.3;

/// Pixels well inside the ball of a column and row of the scene `spheres`.
function inside(column, row) {
    const cx = width / 2 + (column - 3) * unit, cy = height / 2 + (row - 0.5) * unit, radius = 0.4 * unit, pixels = [];
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x) if (Math.hypot(x + 0.5 - cx, y + 0.5 - cy) < radius) pixels.push(y * width + x);
    return pixels;
}

// All pixels of a frame are sampled at the same point within them, where the path tracer draws one for each: what a mirror shows between its
// pixels differs by this part of it, however many samples are drawn.
const k_between_pixels = 0.004;

/// How many standard errors the mean of a ball is away from the truth, at most. first: the mean of `half` frames; all: of twice as many.
function deviation(first, all, truth, pixels) {
    let worst = 0;
    for (let c = 0; c < 3; ++c) {
        let difference = 0, squares = 0, sum = 0;
        for (const p of pixels) {
            const k = 3 * p + c, second = 2 * all[k] - first[k];
            difference += all[k] - truth[k];
            squares += (first[k] - second) ** 2 / 4;
            sum += truth[k];
        }
        worst = Math.max(worst, Math.max(0, Math.abs(difference) - k_between_pixels * sum) / Math.sqrt(squares));
    }
    return worst;
}

export async function testMonteCarlo({all, program, work, open, claim, data}) {
    const run = (...args) => execFileSync(program, args.map(String), {stdio: ['ignore', 'pipe', 'pipe']});
    const environment = path.join(work, 'light.hdr'), truthFile = path.join(work, 'truth.hdr');
    // A photograph without a sun: in a mirror ball a sun is smaller than a pixel, and an interval from so few samples says nothing.
    if (data) run('convert', path.join(data, 'env_latlong/lebombo_1k.hdr'), '-o', environment, '--to', 'latlong', '--size', 128, '--quiet');
    else run('sky', '-o', environment, '--height', 128, '--no-sun-disc', '--quiet');
    run('render', 'spheres', '--env', environment, '--shading', 'reference', '--bounces', 0, '--occlusion', 'off', '--spp', 256, '--width', width, '--height', height, '--quiet', '-o', truthFile);
    const truth = readHdr(truthFile).rgb;
    const page = await open('#mode=monte-carlo&rows=512&panel=false&fullResolution=true', {viewport: {width, height}});
    await openFile(page, '/work/light.hdr', 'light.hdr');
    for (const [strategy, tables] of [['mis', 'guided'], ...(all ? [['mis', 'walk'], ['env', 'guided'], ['brdf', 'guided']] : [])]) {
        await setState(page, {strategy, tables, samples: 2});
        const first = await readPane(page, half), all = await readPane(page, 2 * half);
        const wrong = [];
        let worst = 0;
        for (let row = 0; row < 2; ++row)
            for (let column = 0; column < columns; ++column) {
                // What one strategy alone hardly ever finds has no interval: mirrors by light samples, the sun by the BRDF of a rough surface.
                if (strategy === 'env' && column < 2) continue;
                if (strategy === 'brdf' && (column > 1 || row > 0)) continue;
                const z = deviation(first, all, truth, inside(column, row));
                worst = Math.max(worst, z);
                if (!(z < 4.5)) wrong.push(`ball ${column} of row ${row} is ${z.toFixed(1)} standard errors away`);
            }
        claim(`monte-carlo by ${strategy}, ${tables}: every ball agrees with the path tracer`, wrong, `at most ${worst.toFixed(1)} standard errors`);
    }
    claim('monte-carlo: the console is silent', page.complaints);
    await page.close();
}
