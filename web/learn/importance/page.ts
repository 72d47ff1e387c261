// Importance sampling of an environment: row, then column.

import * as THREE from 'three';
import sampleEnvmap from '../../../docs/shaders/sample_envmap.glsl?raw';
import sphericalEnvmap from '../../../docs/shaders/spherical_envmap.glsl?raw';
import {Pass} from '../../src/render/passes';
import {fullscreen, ownFrame} from '../../src/render/program';
import {element, RangeControl} from '../../src/ui/controls';
import {showCode} from '../common/code';
import {drawMark, latlongPoint, onDrag} from '../common/direction';
import {Facts, fill, Lesson, picture} from '../common/lesson';
import {digits, luminance, mapPass, percent} from '../common/maps';
import {Plot} from '../common/plot';
import follow from './follow.glsl?raw';

const usual = {environment: 'studio', u: 0.6, v: 0.3, count: 128};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_doublings = 10;

const source = mapPass(light);
const pass = new Pass(fullscreen(ownFrame(sphericalEnvmap), sampleEnvmap, follow), {...light.uniforms, u_random: {value: new THREE.Vector2()}, u_count: {value: 1}, u_what: {value: 0}}), u = pass.uniforms;

const map = picture('The environment with the samples, and the one of u and v'), rowCurve = picture('Sum of the row averages from the top, over v'), columnCurve = picture('Sum of the weights along the row, over u');
const facts = new Facts(), plot = new Plot('Error of the diffuse light by the number of samples');
fill('figure', element('div', {className: 'sampled'}, rowCurve, map, element('span'), columnCurve),
     element('p', {className: 'note'}, 'Left: the cumulative function of the rows, 0 to 1 to the right; drag across it for v. Below: that of the columns in the row that was found, 0 to 1 upwards; drag it for u.'));
fill('controls', new RangeControl(values, 'v', 'v: which row', {min: 0, max: 0.999, step: 0.001, text: v => v.toFixed(3)}),
     new RangeControl(values, 'u', 'u: which column', {min: 0, max: 0.999, step: 0.001, text: v => v.toFixed(3)}),
     new RangeControl(values, 'count', 'Samples shown', {min: 0, max: 1024, step: 16}));
fill('facts', facts.root);
fill('plot', plot.root);
showCode('code', 'docs/shaders/sample_envmap.glsl', sampleEnvmap, 'envmapWeight', 'sampleEnvmap', 'diffuseBySamples');
for (const [curve, along] of [[rowCurve, 'v'], [columnCurve, 'u']] as const) {
    curve.classList.add('aimed');
    onDrag(curve, ([x, y]) => values.set({[along]: Math.min(0.999, along === 'v' ? x : 1 - y)}));
}

let exactly = 0;
lesson.onLight(async () => {
    const [r, g, b] = await light.baker.filtered('phong-plain', 1, Float64Array.of(0, 1, 0));
    exactly = luminance(r!, g!, b!);
});

lesson.onDraw(async () => {
    const {width, height} = light.tables, state = lesson.state;
    u.u_what!.value = 0;
    (u.u_random!.value as THREE.Vector2).set(state.u, state.v);
    const [x, y, z, density] = await painter.compute(pass, 1, 1), found = latlongPoint([x!, y!, z!]);
    const column = Math.min(width - 1, Math.floor(found[0] * width)), row = Math.min(height - 1, Math.floor(found[1] * height));
    await drawMap(found, row);
    drawCurve(rowCurve, 120, 360, Array.from({length: height}, (_, j) => light.tables.rows[2 * j]!), state.v, true);
    drawCurve(columnCurve, 720, 120, Array.from({length: width}, (_, i) => light.tables.columns[2 * (row * width + i)]!), state.u, false);
    Object.assign(numbers, {row, column, density});
    facts.set('Row', `${row} of ${height}`);
    facts.set('Column', `${column} of ${width}`);
    facts.set('Density per steradian', digits(density!));
    facts.set('Times that of even sampling, 1/4π', digits(density! * 4 * Math.PI));
    await drawErrors();
});

async function drawMap(found: [number, number], row: number): Promise<void> {
    const {count} = lesson.state, context = await painter.paint(map, source, 720, 360);
    context.fillStyle = 'rgb(255 255 255 / 0.35)';
    context.fillRect(0, (row / light.tables.height) * 360 - 0.5, 720, 2);
    if (count > 0) {
        u.u_what!.value = 1;
        u.u_count!.value = count;
        const samples = await painter.compute(pass, count, 1);
        context.fillStyle = '#ff4fd8';
        for (let k = 0; k < 4 * count; k += 4) {
            const [a, b] = latlongPoint([samples[k]!, samples[k + 1]!, samples[k + 2]!]);
            context.fillRect(a * 720 - 1.5, b * 360 - 1.5, 3, 3);
        }
    }
    drawMark(context, found);
}

/// A cumulative function beside the map, and how a random number finds its place. turned: rows run down, and the sum to the right.
function drawCurve(canvas: HTMLCanvasElement, width: number, height: number, sums: number[], random: number, turned: boolean): void {
    Object.assign(canvas, {width, height});
    const context = canvas.getContext('2d')!, style = getComputedStyle(canvas), n = sums.length;
    const at = (place: number, sum: number): [number, number] => (turned ? [sum * width, place * height] : [place * width, (1 - sum) * height]);
    const i = sums.findIndex(sum => sum > random), below = i > 0 ? sums[i - 1]! : 0, place = (i + (random - below) / (sums[i]! - below)) / n;
    context.lineWidth = 2;
    context.strokeStyle = style.color;
    context.beginPath();
    context.moveTo(...at(0, 0));
    sums.forEach((sum, k) => context.lineTo(...at((k + 1) / n, sum)));
    context.stroke();
    context.strokeStyle = '#ff4fd8';
    context.beginPath();
    context.moveTo(...(turned ? at(1, random) : at(0, random)));
    context.lineTo(...at(place, random));
    context.lineTo(...(turned ? at(place, 1) : at(place, 0)));
    context.stroke();
}

async function drawErrors(): Promise<void> {
    u.u_what!.value = 2;
    const table = await painter.compute(pass, k_doublings, 1);
    const points = Array.from({length: k_doublings}, (_, k) => [2 ** k, Math.abs(luminance(table[4 * k]!, table[4 * k + 1]!, table[4 * k + 2]!) / exactly - 1)] as [number, number]);
    const [n, last] = points.at(-1)!;
    Object.assign(numbers, {exact: exactly, error: last});
    plot.draw({from: 1, to: 2 ** (k_doublings - 1), log: true, ticks: [1, 4, 16, 64, 256], label: 'samples'},
              {from: 1e-4, to: 1, log: true, ticks: [1, 0.1, 0.01, 0.001, 1e-4], text: v => `${+(100 * v).toPrecision(1)} %`, label: 'error of E/π'},
              [{points, dots: true}, {points: points.map(([m]) => [m, points[0]![1] / Math.sqrt(m)]), kind: 'ideal', name: '1 / √n'}], `With ${n} samples the error is ${percent(last)}.`);
}
lesson.start();
