// Three strategies of sampling, side by side.

import * as THREE from 'three';
import {floatTarget} from '../../src/render/passes';
import monteCarlo from '../../src/shading/monte_carlo.glsl?raw';
import {RangeControl} from '../../src/ui/controls';
import {ballUniforms, monteCarloPass, normalAt, showPass, statistics} from '../common/ball';
import {showCode} from '../common/code';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {digits} from '../common/maps';
import {Plot} from '../common/plot';

const usual = {environment: 'studio', roughness: 0.3, directions: 8, NdotV: 0.7, around: 60};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_columns = 16, k_estimates = 512, k_size = 220;

const shared = ballUniforms(), show = showPass(light), target = floatTarget(k_size, k_size);
const strategies = [
    {key: 'brdf', name: 'BRDF', kind: 'other', pass: monteCarloPass(light, shared, 2)},
    {key: 'environment', name: 'environment', kind: 'third', pass: monteCarloPass(light, shared, 1)},
    {key: 'both', name: 'both (MIS)', kind: 'line', pass: monteCarloPass(light, shared, 0)},
].map(strategy => ({...strategy, canvas: picture(`A ball of metal, sampled by ${strategy.name}`)}));

const facts = new Facts(), plot = new Plot('Noise of one point by roughness', 210);
fill('figure', ...strategies.map(({canvas, name}) => figure(canvas, `Directions by ${name}`)));
fill('controls', new RangeControl(values, 'roughness', 'Roughness', {min: 0.03, max: 1, step: 0.01, text: v => v.toFixed(2)}),
     new RangeControl(values, 'directions', 'Directions for each pixel', {min: 2, max: 64, step: 2}),
     new RangeControl(values, 'NdotV', 'Point: n · v', {min: 0.05, max: 1, step: 0.01, text: v => v.toFixed(2)}), new RangeControl(values, 'around', 'Point: around the ball', {min: -180, max: 180, step: 1, text: v => `${v}°`}));
fill('facts', facts.root);
fill('plot', plot.root);
showCode('code', 'web/src/shading/monte_carlo.glsl', monteCarlo, 'shade', 'brdf_pdf');

lesson.onDraw(() => {
    const {roughness, directions, NdotV, around} = lesson.state;
    shared.u_ball_roughness!.value = roughness;
    (shared.u_normal!.value as THREE.Vector3).fromArray(normalAt(NdotV, around));
    shared.u_columns_of_table!.value = k_columns;
    const lines = strategies.map(({key, name, kind, pass, canvas}) => {
        pass.uniforms.u_samples!.value = key === 'both' ? directions / 2 : directions;
        shared.u_what!.value = 0;
        pass.run(painter.renderer, target);
        show.uniforms.u_picture!.value = target.texture;
        painter.paint(canvas, show, k_size, k_size);

        shared.u_what!.value = 1;
        const here = statistics(painter.compute(pass, 1, k_estimates), 1, 0);
        numbers[key] = here.deviation / here.mean;
        numbers[`${key}Mean`] = here.mean;
        numbers[`${key}Error`] = here.deviation / Math.sqrt(here.count);
        facts.set(`Noise by ${name}`, `${(100 * numbers[key]).toPrecision(3)} %`);

        shared.u_what!.value = 2;
        const table = painter.compute(pass, k_columns, k_estimates);
        const points = Array.from({length: k_columns}, (_, i) => {
            const {mean, deviation} = statistics(table, k_columns, i);
            return [(i + 0.5) / k_columns, deviation / Math.max(mean, 1e-9)] as [number, number];
        });
        return {points, kind, name};
    });
    facts.set('Light of the point, by both', `${digits(numbers.bothMean!)} ± ${digits(numbers.bothError!)}`);
    plot.draw({from: 0, to: 1, ticks: [0, 0.25, 0.5, 0.75, 1], label: 'roughness'}, {from: 0.01, to: 30, log: true, ticks: [0.01, 0.1, 1, 10], text: v => `${100 * v} %`, label: 'noise'},
              [...lines, {points: [[roughness, 0.01], [roughness, 30]], kind: 'ideal'}], `At roughness ${roughness}: ${strategies.map(({key, name}) => `${name} ${(100 * numbers[key]!).toPrecision(2)} %`).join(', ')}.`);
});
lesson.start();
