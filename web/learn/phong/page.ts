// Modified Phong by the levels of a chain.

import * as THREE from 'three';
import generic from '../../../docs/shaders/generic.glsl?raw';
import {matchingRoughness, phongLevel} from '../../src/bake/chain';
import {chainTexture} from '../../src/render/maps';
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
const facts = new Facts(), plot = new Plot('The lobe by the angle from the mirror direction', 170);
const exponent = () => 2 ** lesson.state.exponentLog2;
fill('figure', figure(map, 'The light, and the lobe around the mirror direction. Drag to turn it.'), figure(level, 'The light of the lobe for every mirror direction, by the levels of a chain'));
fill('controls', new RangeControl(values, 'exponentLog2', 'Exponent', {min: 0, max: 12, step: 0.25, text: v => digits(2 ** v).replace(/\.?0+$/, '')}), ...directionControls(values, 'Mirror direction'));
fill('facts', facts.root);
fill('exact', figure(truth, 'The same for this exponent without levels between, by the library'), plot.root);
showCode('code', 'web/src/shading/phong.glsl and phong_chain.glsl', phong + phongChain, 'matching_roughness', 'phong_light');

lesson.onLight(async () => {
    const chain = await light.baker.phong(k_size);
    u.u_phong!.value?.dispose();
    u.u_phong!.value = chainTexture(chain);
    u.u_phong_levels!.value = chain.levels.length;
    (u.u_phong_roughness!.value as Float32Array).set(chain.parameters.map(matchingRoughness));
    known = {map: '', light: ''};
});

/// What the library was last asked for.
let known = {map: '', light: ''};
let exactLight: number[] | undefined;

function ask(): void {
    const n = exponent(), {azimuth, elevation} = lesson.state, mapKey = `${light.name} ${n}`, lightKey = `${mapKey} ${azimuth} ${elevation}`;
    if (known.map !== mapKey)
        void lesson.compute('map', () => filteredMap(light, 'phong', n, k_height), rgb => {
            exact.uniforms.u_envmap!.value?.dispose();
            exact.uniforms.u_envmap!.value = mapTexture(rgb, k_height);
        });
    if (known.light !== lightKey) {
        exactLight = undefined;
        void lesson.compute('light', () => light.baker.filtered('phong', n, Float64Array.from(vectorOf(lesson.state))), rgb => (exactLight = [...rgb]));
    }
    known = {map: mapKey, light: lightKey};
}

lesson.onDraw(() => {
    const n = exponent(), mirror = vectorOf(lesson.state);
    u.u_exponent!.value = n;
    (u.u_mirror!.value as THREE.Vector3).fromArray(mirror);
    [map, level].forEach((canvas, what) => {
        u.u_what!.value = what;
        drawMark(painter.paint(canvas, pass, 512, 256), latlongPoint(mirror));
    });
    ask();
    if (exact.uniforms.u_envmap!.value) painter.paint(truth, exact, 256, 128);
    tell(n);
});

function tell(n: number): void {
    u.u_what!.value = 2;
    const [r, g, b] = painter.compute(pass, 1, 1), levels = u.u_phong_levels!.value as number, at = phongLevel(n, levels), half = degrees(Math.acos(0.5 ** (1 / (n + 1))));
    Object.assign(numbers, {level: at, light: luminance(r!, g!, b!)});
    facts.set('Level', at.toFixed(2));
    facts.set('Light by the levels', digits(numbers.light!));
    if (exactLight) {
        numbers.exact = luminance(exactLight[0]!, exactLight[1]!, exactLight[2]!);
        facts.set('Light exactly', digits(numbers.exact));
        facts.set('Error between levels', percent(numbers.light! / numbers.exact - 1));
    }
    facts.set('Half of the peak at', `${half.toFixed(1)}°`);
    const points = Array.from({length: 91}, (_, k) => [k, Math.cos((k * Math.PI) / 180) ** (n + 1)] as [number, number]);
    plot.draw({from: 0, to: 90, ticks: [0, 15, 30, 45, 60, 75, 90], text: v => `${v}°`, label: 'angle from the mirror direction'}, {from: 0, to: 1, ticks: [0, 0.5, 1], label: 'lobe, of its peak'},
              [{points}, {points: [[half, 0], [half, 0.5], [0, 0.5]], kind: 'ideal'}], `At ${half.toFixed(1)} degrees it is half of its peak.`);
}
lesson.start();
