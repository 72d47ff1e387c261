// Irradiance by a Riemann sum, and exactly.

import * as THREE from 'three';
import {Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import {RangeControl} from '../../src/ui/controls';
import {showCode} from '../common/code';
import {directionAt, directionControls, drawMark, latlongPoint, onDrag, vectorOf} from '../common/direction';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {digits, filteredMap, luminance, mapParts, mapPass, mapTexture, percent} from '../common/maps';
import {Plot} from '../common/plot';
import riemann from './riemann.glsl?raw';

const usual = {environment: 'studio', k: 16, j: 4, azimuth: 60, elevation: 30};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_height = 32, k_doublings = 7;

const sum = new Pass(fullscreen(...mapParts, riemann), {...light.uniforms, u_normal: {value: new THREE.Vector3()}, u_k: {value: 1}, u_j: {value: 1}, u_what: {value: 0}});
const source = mapPass(light), exact = mapPass(light);
exact.uniforms.u_envmap = {value: null};

const map = picture('The environment, with the directions of the sum'), bySum = picture('The sum for every normal'), byLibrary = picture('The exact value for every normal');
map.classList.add('aimed');
const facts = new Facts(), plot = new Plot('Error of the sum by the number of its terms');
onDrag(map, point => values.set(directionAt(point)));
fill('figure', figure(map, 'The light, with the directions that are summed. Drag to turn the normal; what it does not see is dark.'));
fill('controls', new RangeControl(values, 'k', 'K: steps of φ', {min: 1, max: 256, step: 1}), new RangeControl(values, 'j', 'J: steps of θ', {min: 1, max: 64, step: 1}), ...directionControls(values, 'Normal'));
fill('facts', facts.root);
fill('maps', figure(bySum, 'E/π of every normal, by the sum with these K and J'), figure(byLibrary, 'E/π of every normal, exactly'));
fill('plot', plot.root);
showCode('code', 'web/learn/irradiance/riemann.glsl', riemann, 'step_direction', 'irradiance_sum');

lesson.onLight(async () => {
    exact.uniforms.u_envmap!.value?.dispose();
    exact.uniforms.u_envmap!.value = mapTexture(await filteredMap(light, 'phong-plain', 1, k_height), k_height);
});

lesson.onDraw(async () => {
    const {k, j} = lesson.state, normal = vectorOf(lesson.state), u = sum.uniforms;
    (u.u_normal!.value as THREE.Vector3).fromArray(normal);
    u.u_k!.value = k;
    u.u_j!.value = j;
    await drawMap(normal);
    // A clamped cosine over π is the plain Phong lobe of exponent 1.
    await drawErrors([...(await lesson.answer(light.baker.filtered('phong-plain', 1, Float64Array.from(normal))))].map(v => v * Math.PI));
    u.u_what!.value = 0;
    await painter.paint(bySum, sum, 2 * k_height, k_height);
    await painter.paint(byLibrary, exact, 4 * k_height, 2 * k_height);
});

async function drawMap(normal: [number, number, number]): Promise<void> {
    const {k, j} = lesson.state, width = 720, height = 360, u = sum.uniforms;
    (source.uniforms.u_facing!.value as THREE.Vector3).fromArray(normal);
    const context = await painter.paint(map, source, width, height);
    u.u_what!.value = 2;
    const directions = await painter.compute(sum, k, j), radius = Math.max(0.8, Math.min(3, 40 / Math.sqrt(k * j)));
    context.fillStyle = '#ff4fd8';
    for (let i = 0; i < 4 * k * j; i += 4) {
        const [x, y] = latlongPoint([directions[i]!, directions[i + 1]!, directions[i + 2]!]);
        context.fillRect(x * width - radius, y * height - radius, 2 * radius, 2 * radius);
    }
    drawMark(context, latlongPoint(normal));
}

async function drawErrors([r, g, b]: number[]): Promise<void> {
    const {k, j} = lesson.state, exactly = luminance(r!, g!, b!);
    sum.uniforms.u_what!.value = 1;
    const table = await painter.compute(sum, k_doublings + 1, 1), of = (i: number) => luminance(table[4 * i]!, table[4 * i + 1]!, table[4 * i + 2]!);
    const error = of(0) / exactly - 1;
    Object.assign(numbers, {sum: of(0), exact: exactly, error});
    facts.set('E by the sum', digits(of(0)));
    facts.set('E exactly', digits(exactly));
    facts.set('Error', percent(error));
    facts.set('Terms K · J', String(k * j));
    const points = Array.from({length: k_doublings}, (_, i) => [4 * 4 ** i, Math.abs(of(i + 1) / exactly - 1)] as [number, number]);
    const top = points.some(([, v]) => v > 1) || Math.abs(error) > 1 ? 100 : 1, axis = {from: 1e-5, to: top, log: true, ticks: [100, 10, 1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5].filter(v => v <= top), text: (v: number) => `${+(100 * v).toPrecision(1)} %`, label: 'error of E'};
    plot.draw({from: 1, to: 32768, log: true, ticks: [1, 4, 16, 64, 256, 1024, 4096, 16384], label: 'terms K · J'}, axis,
              [{points, kind: 'line', dots: true, name: 'K = 4 J'}, {points: [[k * j, Math.abs(error)]], kind: 'other', dots: true, name: 'your K and J'}],
              `With ${k * j} terms the error is ${percent(error)}.`);
}
lesson.start();
