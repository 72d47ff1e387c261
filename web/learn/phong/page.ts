// Modified Phong by the levels of a chain.

import * as THREE from 'three';
import generic from '../../../docs/shaders/generic.glsl?raw';
import {matchingRoughness, phongLevel} from '../../src/bake/chain';
import {chainTexture, cubeTexture} from '../../src/render/maps';
import {Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import {degrees} from '../../src/scene/framing';
import diffuse from '../../src/shading/diffuse.glsl?raw';
import material from '../../src/shading/material.glsl?raw';
import phong from '../../src/shading/phong.glsl?raw';
import phongChain from '../../src/shading/phong_chain.glsl?raw';
import {RangeControl} from '../../src/ui/controls';
import {showCode} from '../common/code';
import {directionAt, directionControls, drawMark, latlongPoint, onDrag, vectorOf} from '../common/direction';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {digits, filteredMap, luminance, mapParts, mapPass, mapTexture, percent} from '../common/maps';
import {Plot} from '../common/plot';
import filtered from './filtered.glsl?raw';

const usual = {environment: 'studio', exponentLog2: 6, azimuth: 30, elevation: 20};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_height = 32, k_size = 256;
/// Exponents 2^(k/4) of the plot of errors.
const k_exponents = 45;

const pass = new Pass(fullscreen(...mapParts, generic, diffuse, material, phongChain, phong, filtered), {
    ...light.uniforms, u_mirror: {value: new THREE.Vector3()}, u_what: {value: 0}, u_exponent: {value: 1}, u_phong: {value: null}, u_irradiance: {value: null},
    u_phong_roughness: {value: new Float32Array(16)}, u_phong_levels: {value: 1}, u_harmonics: {value: false}, u_specular: {value: null}, u_brdf: {value: null},
    u_last_level: {value: 1}, u_sh: {value: Array.from({length: 9}, () => new THREE.Vector3())},
}), u = pass.uniforms;
const exact = mapPass(light);
exact.uniforms.u_envmap = {value: null};

const map = picture('The environment with the lobe over it'), level = picture('The filtered map by the levels'), truth = picture('The filtered map, exactly');
for (const canvas of [map, level]) {
    canvas.classList.add('aimed');
    onDrag(canvas, point => values.set(directionAt(point)));
}
const facts = new Facts(), plot = new Plot('The lobe by the angle from the mirror direction', 170), losses = new Plot('Error of the mix by exponent', 170);
const exponent = () => 2 ** lesson.state.exponentLog2;
fill('figure', figure(map, 'The light, and the lobe around the mirror direction. Drag to turn it.'), figure(level, 'The light of the lobe for every mirror direction, by the levels of a chain'));
fill('controls', new RangeControl(values, 'exponentLog2', 'Exponent', {min: 0, max: 12, step: 0.25, text: v => digits(2 ** v).replace(/\.?0+$/, '')}), ...directionControls(values, 'Mirror direction'));
fill('facts', facts.root);
fill('exact', figure(truth, 'The same for this exponent without levels between, by the library'), plot.root);
fill('plot', losses.root);
showCode('code', 'web/src/shading/phong.glsl and phong_chain.glsl', phong + phongChain, 'matching_roughness', 'phong_light');

/// Of the levels but the first, which is sharp.
let levelExponents: number[] = [];

lesson.onLight(async () => {
    const chain = await light.baker.phong(k_size), {irradiance} = await light.baker.bake(k_size / 4);
    for (const name of ['u_phong', 'u_irradiance']) u[name]!.value?.dispose();
    u.u_irradiance!.value = cubeTexture([irradiance]);  // below the exponent of the last level
    u.u_phong!.value = chainTexture(chain);
    u.u_phong_levels!.value = chain.levels.length;
    (u.u_phong_roughness!.value as Float32Array).set(chain.parameters.map(matchingRoughness));
    levelExponents = chain.parameters.filter(Number.isFinite);
});

lesson.onDraw(async () => {
    const n = exponent(), mirror = vectorOf(lesson.state);
    u.u_exponent!.value = n;
    (u.u_mirror!.value as THREE.Vector3).fromArray(mirror);
    for (const [what, canvas] of [map, level].entries()) {
        u.u_what!.value = what;
        drawMark(await painter.paint(canvas, pass, 512, 256), latlongPoint(mirror));
    }
    await tell(n, await lesson.answer(light.baker.filtered('phong', n, Float64Array.from(mirror))));
    await drawExact(n);
    await drawLosses(n, mirror);
});

/// Exact lights of the exponents, and the light and direction that they are of.
let known: {tables?: unknown; mirror?: string; exact: number[]} = {exact: []};
async function drawLosses(n: number, mirror: [number, number, number]): Promise<void> {
    const {tables} = light, key = String(mirror);
    if (known.tables !== tables || known.mirror !== key) {
        const exact: number[] = [];
        for (let k = 0; k < k_exponents; ++k) {
            const [r, g, b] = await lesson.answer(light.baker.filtered('phong', 2 ** (k / 4), Float64Array.from(mirror)));
            exact.push(luminance(r!, g!, b!));
        }
        known = {tables, mirror: key, exact};
    }
    u.u_what!.value = 3;
    const table = await painter.compute(pass, k_exponents, 1);
    const points = known.exact.map((exactly, k) => [2 ** (k / 4), luminance(table[4 * k]!, table[4 * k + 1]!, table[4 * k + 2]!) / exactly - 1] as [number, number]);
    const most = points.reduce((m, [, v]) => Math.max(m, Math.abs(v)), 1e-4), digit = 10 ** Math.floor(Math.log10(most)), top = [1, 2, 5, 10].map(v => v * digit).find(v => v >= most)!;
    const levels = levelExponents.map(exponent => ({points: [[exponent, -top], [exponent, top]] as [number, number][], kind: 'ideal'}));
    losses.draw({from: 1, to: 2048, log: true, ticks: [2, 8, 32, 128, 512, 2048], label: 'exponent'}, {from: -top, to: top, ticks: [-top, 0, top], text: v => `${v < 0 ? '−' : ''}${+Math.abs(100 * v).toPrecision(2)} %`, label: 'error'},
                [...levels, {points}, {points: n <= 2048 ? [[n, numbers.light! / numbers.exact! - 1]] : [], kind: 'other', dots: true, name: 'your exponent'}], `At the exponent ${digits(n)} it is ${percent(numbers.light! / numbers.exact! - 1)}; at most ${percent(most)}.`);
}

/// Which light and exponent the exact map is of.
let filteredFor: {tables: unknown; n: number} | undefined;
async function drawExact(n: number): Promise<void> {
    const {tables} = light;
    if (filteredFor?.tables !== tables || filteredFor.n !== n) {
        const rgb = await lesson.answer(filteredMap(light, 'phong', n, k_height));
        exact.uniforms.u_envmap!.value?.dispose();
        exact.uniforms.u_envmap!.value = mapTexture(rgb, k_height);
        filteredFor = {tables, n};
    }
    await painter.paint(truth, exact, 256, 128);
}

async function tell(n: number, exactLight: Float32Array): Promise<void> {
    u.u_what!.value = 2;
    const [r, g, b] = await painter.compute(pass, 1, 1), levels = u.u_phong_levels!.value as number, at = phongLevel(n, levels), half = degrees(Math.acos(0.5 ** (1 / (n + 1))));
    Object.assign(numbers, {level: at, light: luminance(r!, g!, b!)});
    facts.set('Level', at.toFixed(2));
    facts.set('Light by the levels', digits(numbers.light!));
    numbers.exact = luminance(exactLight[0]!, exactLight[1]!, exactLight[2]!);
    facts.set('Light exactly', digits(numbers.exact));
    facts.set('Error between levels', percent(numbers.light! / numbers.exact - 1));
    facts.set('Half of the peak at', `${half.toFixed(1)}°`);
    const points = Array.from({length: 91}, (_, k) => [k, Math.cos((k * Math.PI) / 180) ** (n + 1)] as [number, number]);
    plot.draw({from: 0, to: 90, ticks: [0, 15, 30, 45, 60, 75, 90], text: v => `${v}°`, label: 'angle from the mirror direction'}, {from: 0, to: 1, ticks: [0, 0.5, 1], label: 'lobe, of its peak'},
              [{points}, {points: [[half, 0], [half, 0.5], [0, 0.5]], kind: 'ideal'}], `At ${half.toFixed(1)} degrees it is half of its peak.`);
}
lesson.start();
