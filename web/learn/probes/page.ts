// The light of a point from the eight probes around it: the app's own shaders, on rooms whose light is known everywhere.

import * as THREE from 'three';
import {setProbeUniforms, probeUniforms} from '../../src/probes/textures';
import {Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import probeBlend from '../../src/shading/probe_blend.glsl?raw';
import probeCells from '../../src/shading/probe_cells.glsl?raw';
import probeLight from '../../src/shading/probe_light.glsl?raw';
import probeRecords from '../../src/shading/probe_records.glsl?raw';
import probeVisibility from '../../src/shading/probe_visibility.glsl?raw';
import {CheckControl, ChoiceControl, element, RangeControl} from '../../src/ui/controls';
import {showCode} from '../common/code';
import {drawMark, onDrag} from '../common/direction';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {digits, luminance, mapParts} from '../common/maps';
import {irradianceOverPi, k_half_wall, k_probes, k_size, placedProbes, rooms, setOf, windowLight} from './capture';
import './probes.css';
import room from './room.glsl?raw';

const normals = {up: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0]} as const;
const usual = {environment: 'studio', x: 3.35, z: 1.8, height: 0.9, wall: 3, normal: 'up' as keyof typeof normals, blend: 8, visibility: true, parallax: true};
const lesson = new Lesson(usual, {normal: Object.keys(normals)}), {light, painter, values, numbers} = lesson;
/// A plan is computed with half as many points along each side as it is shown with.
const k_width = 480, k_computed = 240, k_ball = 144;
const k_exposure = 0.9;

const set = probeUniforms(), u = {
    ...light.uniforms, ...set, u_exposure: {value: k_exposure}, u_brdf: {value: null}, u_wall: {value: 3}, u_window: {value: new THREE.Vector3()}, u_what: {value: 0}, u_face_size: {value: k_size},
    u_point: {value: new THREE.Vector3()}, u_facing: {value: new THREE.Vector3()},
};
const pass = new Pass(fullscreen(...mapParts, probeRecords, probeVisibility, probeCells, probeBlend, probeLight, room), u);

const plans = [picture('The rooms from above, lit by the probes'), picture('The rooms from above, the truth')] as const;
for (const canvas of plans) {
    canvas.classList.add('aimed');
    onDrag(canvas, ([across, down]) => values.set({x: across * rooms[0], z: down * rooms[2]}));
}
const balls = [picture('A mirror ball by the probes with parallax'), picture('A mirror ball by the probes without parallax'), picture('A mirror ball, the truth')] as const;
const facts = new Facts(), rows = element('tbody');
const metres = (v: number) => `${v.toFixed(2)} m`;
fill('plans', figure(plans[0], 'E / π by the probes (circles; crossed out where they are inside the wall). Drag the point.'), figure(plans[1], 'The truth: the integral itself at every point'));
fill('controls', new RangeControl(values, 'x', 'Point: x', {min: 0, max: rooms[0], step: 0.01, text: metres}), new RangeControl(values, 'z', 'Point: z', {min: 0, max: rooms[2], step: 0.01, text: metres}),
     new RangeControl(values, 'height', 'Height', {min: 0.05, max: rooms[1] - 0.05, step: 0.05, text: metres}), new RangeControl(values, 'wall', 'Wall at x', {min: 1.5, max: 4.5, step: 0.05, text: metres}),
     new ChoiceControl(values, 'normal', 'The surface faces', [['up', 'Up'], ['left', 'Left'], ['right', 'Right']]), new RangeControl(values, 'blend', 'Probes blended', {min: 1, max: 8, step: 1}),
     new CheckControl(values, 'visibility', 'Visibility'), new CheckControl(values, 'parallax', 'Parallax (first ball)'));
fill('facts', facts.root);
fill('table', element('table', {}, element('thead', {}, element('tr', {}, ...['Probe at', 't', 'v', 'C', 'f', 'weight'].map(text => element('th', {scope: 'col'}, text)))), rows));
fill('balls', ...balls.map((canvas, k) => figure(canvas, ['By the probes, as chosen above', 'By the probes without parallax', 'The truth'][k]!)));
showCode('code-weights', 'web/src/shading/probe_blend.glsl', probeBlend, 'importance', 'add_grid_cell');
showCode('code-visibility', 'web/src/shading/probe_visibility.glsl', probeVisibility, 'chebyshev_visibility', 'probe_visibility');
showCode('code-parallax', 'web/src/shading/probe_light.glsl', probeLight, 'parallax_direction');

/// For which wall and environment the probes were captured last.
let captured: {wall?: number; tables?: unknown} = {}, probes = placedProbes(3);

/// Captures all probes, as `domelight probes` does: their places first, then their cubes.
async function capture(wall: number): Promise<void> {
    const {tables} = light;
    if (captured.wall === wall && captured.tables === tables) return;
    captured = {};
    probes = placedProbes(wall);
    const empty = new Float32Array(4 * 6 * k_size * k_size * k_probes), run = (what: number) => {
        u.u_what.value = what;
        return painter.compute(pass, k_size, 6 * k_size * k_probes);
    };
    setProbeUniforms(set, setOf(probes, empty, empty, empty), k_probes);  // the shader reads the places from it
    const radiance = await run(5), moments = await run(6);
    setProbeUniforms(set, setOf(probes, radiance, moments, await irradianceOverPi(radiance, () => painter.pause())), k_probes);
    captured = {wall, tables};
    drawnPlans = ['', ''];
}

const smallPlans = plans.map(() => element('canvas'));
let drawnPlans = ['', ''];

/// A plan, computed again only if what it depends on has changed. Returns where to draw over it.
async function drawPlan(k: 0 | 1): Promise<CanvasRenderingContext2D> {
    const {height, normal, blend, visibility} = lesson.state, small = smallPlans[k]!, key = String([height, normal, ...(k === 0 ? [blend, visibility] : [])]);
    u.u_what.value = k;
    if (key !== drawnPlans[k]) await painter.paint(small, pass, k_computed, k_computed / 2);
    drawnPlans[k] = key;
    const canvas = plans[k], context = canvas.getContext('2d')!;
    Object.assign(canvas, {width: k_width, height: k_width / 2});
    context.drawImage(small, 0, 0, k_width, k_width / 2);
    return context;
}

/// A point that is inside the wall is moved out of it.
function outOfWall(x: number, wall: number): number {
    return Math.abs(x - wall) > k_half_wall ? x : wall + (x < wall ? -1.02 : 1.02) * k_half_wall;
}

/// The probes on the plan: the blended ones are large by their weight.
function markProbes(context: CanvasRenderingContext2D, point: [number, number], weights: number[]): void {
    const {width, height} = context.canvas, place = (x: number, z: number) => [(x / rooms[0]) * width, (z / rooms[2]) * height] as const;
    probes.forEach(({position: [x, , z], valid}, k) => {
        const [px, py] = place(x, z), weight = weights[k]!, radius = 4 + 14 * Math.sqrt(weight);
        for (const [style, line] of [['#000', 3.5], [valid ? '#fff' : '#ff5fae', 1.5]] as const) {
            context.strokeStyle = style;
            context.lineWidth = line;
            context.beginPath();
            if (weight > 0.001) context.moveTo(point[0] * width, point[1] * height), context.lineTo(px, py);
            context.moveTo(px + radius, py);
            context.arc(px, py, radius, 0, 2 * Math.PI);
            if (!valid) context.moveTo(px - 5, py - 5), context.lineTo(px + 5, py + 5), context.moveTo(px - 5, py + 5), context.lineTo(px + 5, py - 5);
            context.stroke();
        }
    });
}

/// The numbers of the corners of a point's cell, as the shader counts them.
function cornersAt(point: number[]): number[] {
    const {origin, spacing, counts} = {origin: set.u_probe_origin!.value.toArray(), spacing: set.u_probe_spacing!.value.toArray(), counts: set.u_probe_counts!.value.toArray()};
    const low = point.map((v, k) => Math.min(counts[k] - 2, Math.floor(Math.min(counts[k] - 1, Math.max(0, (v - origin[k]) / spacing[k])))));
    return Array.from({length: 8}, (_, i) => low[0]! + (i & 1) + counts[0] * (low[1]! + ((i >> 1) & 1) + counts[1] * (low[2]! + (i >> 2))));
}

async function tell(point: number[]): Promise<number[]> {
    u.u_what.value = 4;
    const table = await painter.compute(pass, k_probes, 3), at = (column: number, row: number) => [...table.subarray(4 * (row * k_probes + column), 4 * (row * k_probes + column) + 4)] as [number, number, number, number];
    const weights = Array.from({length: k_probes}, (_, k) => at(k, 1)[0]), corners = cornersAt(point), [r, g, b] = at(0, 2), [tr, tg, tb] = at(1, 2);
    const factors = corners.map((_, i) => at(i, 0)), filled = 1 - corners.reduce((sum, k) => sum + weights[k]!, 0);
    rows.replaceChildren(...corners.map((k, i) => element('tr', {}, element('td', {}, probes[k]!.position.map(v => v.toFixed(1)).join(', ')), ...[...factors[i]!, weights[k]!].map(v => element('td', {}, v.toFixed(3))))));
    const blended = luminance(r, g, b), truth = luminance(tr, tg, tb);
    Object.assign(numbers, {probes: blended, truth, ratio: blended / truth, filled, sum: weights.reduce((a, v) => a + v, 0), trilinear: factors.reduce((a, [t]) => a + t, 0)});
    corners.forEach((k, i) => Object.assign(numbers, {[`product${i}`]: factors[i]!.reduce((a, v) => a * v, 1), [`weight${i}`]: weights[k]!, [`t${i}`]: factors[i]![0]}));
    facts.set('E / π by the probes', digits(blended));
    facts.set('The truth', digits(truth));
    facts.set('Probes over truth', `${(blended / truth).toPrecision(3)}`);
    facts.set('From other than these eight', `${(100 * Math.max(0, filled)).toFixed(0)} %`);
    return weights;
}

lesson.onDraw(async () => {
    const {x, z, height, wall, normal, blend, visibility, parallax} = lesson.state, point = [outOfWall(x, wall), height, z];
    u.u_exposure.value = k_exposure;
    u.u_wall.value = wall;
    u.u_window.value.fromArray(windowLight(light.tables, 4 / (light.mean || 1)));
    u.u_point.value.fromArray(point);
    u.u_facing.value.fromArray(normals[normal]);
    await capture(wall);
    set.u_probe_most!.value = blend;
    set.u_probe_use_visibility!.value = visibility;
    set.u_probe_use_all!.value = !visibility;
    set.u_probe_parallax!.value = parallax;
    const weights = await tell(point), mark: [number, number] = [point[0]! / rooms[0], z / rooms[2]];
    for (const k of [0, 1] as const) {
        const context = await drawPlan(k);
        if (k === 0) markProbes(context, mark, weights);
        drawMark(context, mark);
    }
    for (const [k, canvas] of balls.entries()) {
        u.u_exposure.value = Math.max(k_exposure, 0.4 / numbers.truth!);
        u.u_what.value = k < 2 ? 2 : 3;
        set.u_probe_parallax!.value = k === 0 && parallax;
        await painter.paint(canvas, pass, k_ball, k_ball);
    }
});
lesson.start();
