// Three strategies of sampling, side by side.

import * as THREE from 'three';
import {floatTarget, Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import monteCarlo from '../../src/shading/monte_carlo.glsl?raw';
import {element, RangeControl} from '../../src/ui/controls';
import {ballUniforms, monteCarloParts, monteCarloPass, normalAt, showPass, statistics} from '../common/ball';
import {showCode} from '../common/code';
import {figure, fill, Lesson, picture} from '../common/lesson';
import {withError} from '../common/maps';
import {Plot} from '../common/plot';
import moments from './moments.glsl?raw';

const usual = {environment: 'studio', roughness: 0.3, directions: 8, NdotV: 0.7, around: 60};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_columns = 25, k_rows = 64, k_estimates = 512, k_size = 220;

const shared = ballUniforms(), show = showPass(light), target = floatTarget(k_size, k_size);
const strategies = [
    {key: 'brdf', name: 'BRDF', kind: 'other', pass: monteCarloPass(light, shared, 2)},
    {key: 'environment', name: 'environment', kind: 'third', pass: monteCarloPass(light, shared, 1)},
    {key: 'both', name: 'both (MIS)', kind: 'line', pass: monteCarloPass(light, shared, 0)},
].map(strategy => ({...strategy, canvas: picture(`A ball of metal, sampled by ${strategy.name}`)}));

const noise = new Pass(fullscreen(...monteCarloParts, moments), {
    ...light.uniforms, u_normal: shared.u_normal!, u_columns_of_table: {value: 1}, u_directions: {value: 32}, u_strategy: {value: 0}, u_tables: {value: 1}, u_samples: {value: 1}, u_frame: {value: 0},
});
const rows = element('tbody'), plot = new Plot('Noise of one point by roughness', 210);
fill('figure', ...strategies.map(({canvas, name}) => figure(canvas, `Directions by ${name}`)));
fill('controls', new RangeControl(values, 'roughness', 'Roughness', {min: 0.03, max: 1, step: 0.01, text: v => v.toFixed(2)}),
     new RangeControl(values, 'directions', 'Directions for each pixel', {min: 2, max: 64, step: 2}),
     new RangeControl(values, 'NdotV', 'Point: n · v', {min: 0.05, max: 1, step: 0.01, text: v => v.toFixed(2)}), new RangeControl(values, 'around', 'Point: around the ball', {min: -180, max: 180, step: 1, text: v => `${v}°`}));
fill('facts', element('table', {}, element('caption', {className: 'sr'}, 'Noise and light by each strategy'),
    element('thead', {}, element('tr', {}, ...['Directions by', 'Noise of a pixel', `Light of the point, by ${k_estimates} pixels`].map(text => element('th', {scope: 'col'}, text)))), rows));
fill('plot', plot.root);
showCode('code', 'web/src/shading/monte_carlo.glsl', monteCarlo, 'shade', 'brdf_pdf');
showCode('code-noise', 'web/learn/mis/moments.glsl', moments, 'add_direction');

lesson.onDraw(async () => {
    const {roughness, directions, NdotV, around} = lesson.state;
    shared.u_ball_roughness!.value = roughness;
    (shared.u_normal!.value as THREE.Vector3).fromArray(normalAt(NdotV, around));
    for (const {key, pass, canvas} of strategies) {
        pass.uniforms.u_samples!.value = key === 'both' ? directions / 2 : directions;
        shared.u_what!.value = 0;
        await painter.run(pass, target);
        show.uniforms.u_picture!.value = target.texture;
        await painter.paint(canvas, show, k_size, k_size);
    }
    await drawNoise();
    const lines: HTMLElement[] = [];
    for (const {key, name, pass} of strategies) {
        shared.u_what!.value = 1;
        const {mean, deviation, count} = statistics(await painter.compute(pass, 1, k_estimates)), error = deviation / Math.sqrt(count);
        Object.assign(numbers, {[`${key}Mean`]: mean, [`${key}Error`]: error, [`${key}Measured`]: deviation / mean});
        lines.push(element('tr', {}, element('th', {scope: 'row'}, name), element('td', {}, percentage(numbers[key]!)), element('td', {}, withError(mean, error))));
    }
    rows.replaceChildren(...lines);
});

const percentage = (v: number) => `${v < 1 ? (100 * v).toPrecision(2) : Math.round(100 * v)} %`;

/// The noise of a pixel for each roughness: the standard deviation of its estimate over its mean.
async function drawNoise(): Promise<void> {
    const {roughness, directions} = lesson.state, columns = k_columns, points: Record<string, [number, number][]> = {brdf: [], environment: [], both: []};
    const noiseOf = (table: Float32Array, width: number, column: number) => {
        const mean = (row: number, c: number) => Array.from({length: k_rows}, (_, k) => table[4 * ((2 * k + row) * width + column) + c]!).reduce((a, v) => a + v) / k_rows;
        const [ia, ib] = [mean(1, 0), mean(1, 1)], light = Math.max(ia + ib, 1e-30), of = (variance: number, n: number) => Math.sqrt(Math.max(0, variance) / n) / light;
        return {brdf: of(mean(0, 0) - light ** 2, directions), environment: of(mean(0, 1) - light ** 2, directions), both: of(mean(0, 2) - ia ** 2 - ib ** 2, directions / 2)};
    };
    noise.uniforms.u_columns_of_table!.value = columns;
    const table = await painter.compute(noise, columns, 2 * k_rows);
    for (let i = 0; i < columns; ++i) for (const [key, value] of Object.entries(noiseOf(table, columns, i))) points[key]!.push([(i + 0.5) / columns, value]);
    noise.uniforms.u_columns_of_table!.value = 0.5 / roughness;
    Object.assign(numbers, noiseOf(await painter.compute(noise, 1, 2 * k_rows), 1, 0));
    const most = Math.max(...Object.values(points).flat().map(([, v]) => v)), top = Math.min(100, Math.max(10, 10 ** Math.ceil(Math.log10(most)))), ticks = Array.from({length: 2 + Math.round(Math.log10(top)) + 1}, (_, k) => 10 ** (k - 2));
    plot.draw({from: 0, to: 1, ticks: [0, 0.25, 0.5, 0.75, 1], label: 'roughness'}, {from: 0.01, to: top, log: true, ticks, text: v => `${100 * v} %`, label: 'noise'},
              [...strategies.map(({key, kind, name}) => ({points: points[key]!, kind, name})), {points: [[roughness, 0.01], [roughness, top]], kind: 'ideal'}],
              `At roughness ${roughness}: ${strategies.map(({key, name}) => `${name} ${percentage(numbers[key]!)}`).join(', ')}.`);
}
lesson.start();
