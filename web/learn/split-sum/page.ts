// The split sum beside Monte Carlo.

import * as THREE from 'three';
import generic from '../../../docs/shaders/generic.glsl?raw';
import {brdfTable} from '../../src/bake/brdf_table';
import {brdfTexture, chainTexture, cubeTexture} from '../../src/render/maps';
import {Pane} from '../../src/render/pane';
import {floatTarget, Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import diffuse from '../../src/shading/diffuse.glsl?raw';
import material from '../../src/shading/material.glsl?raw';
import metallicRoughness from '../../src/shading/metallic_roughness.glsl?raw';
import splitSum from '../../src/shading/split_sum.glsl?raw';
import {RangeControl} from '../../src/ui/controls';
import {ballPass, ballUniforms, monteCarloParts, monteCarloPass, normalAt, showPass, statistics} from '../common/ball';
import {showCode} from '../common/code';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {digits, luminance, percentWithError, withError} from '../common/maps';
import table from './table.glsl?raw';

const usual = {environment: 'studio', roughness: 0.4, NdotV: 0.2, around: 75, count: 64};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const k_size = 220, k_table = 128, k_frames = 32, k_samples = 8;

const shared = ballUniforms(), show = showPass(light), bySplit = floatTarget(k_size, k_size), pane = new Pane(painter.renderer);
const split = ballPass(light, {
    ...shared, u_specular: {value: null}, u_irradiance: {value: null}, u_brdf: {value: null}, u_last_level: {value: 1}, u_sh: {value: Array.from({length: 9}, () => new THREE.Vector3())},
    u_harmonics: {value: false}, u_multiple_scattering: {value: false}, u_fresnel_weight: {value: false}, u_bent_lookup: {value: false},
}, generic, diffuse, material, metallicRoughness, splitSum);
const monteCarlo = monteCarloPass(light, shared, 0);
const tables = new Pass(fullscreen(...monteCarloParts, table), {
    ...light.uniforms, u_what: {value: 0}, u_count: {value: 1}, u_cosine: {value: 1}, u_lobe_roughness: {value: 1},
    u_strategy: {value: 0}, u_tables: {value: 1}, u_samples: {value: 1}, u_frame: {value: 0},
});
pane.resize(k_size, k_size);

const splitBall = picture('The ball by split-sum'), trueBall = picture('The ball by Monte Carlo'), difference = picture('Where split-sum is too bright or too dark');
const trueLobe = picture('The true lobe on the hemisphere, seen from above'), mapLobe = picture('The lobe of the map on the hemisphere'), sampled = picture('The table by samples');
for (const canvas of [splitBall, trueBall, difference, trueLobe, mapLobe]) canvas.classList.add('discs');
const facts = new Facts(), tableFacts = new Facts();
fill('figure', figure(splitBall, 'Split-sum'), figure(trueBall, 'Monte Carlo, as it converges'), figure(difference, 'Red: split-sum is too bright; blue: too dark'));
fill('controls', new RangeControl(values, 'roughness', 'Roughness', {min: 0.05, max: 1, step: 0.01, text: v => v.toFixed(2)}),
     new RangeControl(values, 'NdotV', 'Point: n · v', {min: 0.03, max: 1, step: 0.01, text: v => v.toFixed(2)}), new RangeControl(values, 'around', 'Point: around the ball', {min: -180, max: 180, step: 1, text: v => `${v}°`}));
fill('facts', facts.root);
fill('lobes', figure(trueLobe, 'The true lobe, f cos θ, from above: more than a half, a tenth and a hundredth of its peak'), figure(mapLobe, 'The lobe of the map, which is round about r; seen from above, what is round becomes narrow near the horizon'));
fill('table', figure(sampled, 'By N samples'), tableFacts.root);
fill('table', new RangeControl(values, 'count', 'N: samples of the table', {min: 1, max: 512, step: 1}));
showCode('code', 'web/src/shading/split_sum.glsl', splitSum, 'lookup_direction', 'shade');
showCode('lobecode', 'web/learn/split-sum/table.glsl', table, 'true_lobe', 'map_lobe');
showCode('tablecode', 'web/learn/split-sum/table.glsl', table, 'integrate_brdf');

/// (A, B) of the library, k_table x k_table.
let exactTable: Float32Array | undefined;

lesson.onLight(async () => {
    const bake = await light.baker.bake(128), u = split.uniforms;
    for (const name of ['u_specular', 'u_irradiance']) u[name]!.value?.dispose();
    u.u_specular!.value = chainTexture(bake.specular);
    u.u_irradiance!.value = cubeTexture([bake.irradiance]);
    u.u_last_level!.value = bake.specular.levels.length - 1;
    if (exactTable) return;
    const brdf = await brdfTable();
    u.u_brdf!.value = brdfTexture(brdf);
    exactTable = Float32Array.from(brdf.texels, THREE.DataUtils.fromHalfFloat);
});

lesson.onDraw(async () => {
    const {roughness, NdotV, around} = lesson.state;
    shared.u_ball_roughness!.value = roughness;
    (shared.u_normal!.value as THREE.Vector3).fromArray(normalAt(NdotV, around));
    shared.u_what!.value = 0;
    await painter.run(split, bySplit);
    await present(splitBall, bySplit.texture);
    await drawPoint();
    await drawLobes();
    await drawTable();
    pane.count = 0;
    await refine();
}, refine);

/// One more frame of Monte Carlo, until there are enough.
async function refine(): Promise<boolean> {
    shared.u_what!.value = 0;
    monteCarlo.uniforms.u_samples!.value = k_samples;
    monteCarlo.uniforms.u_frame!.value = pane.count;
    pane.advance(() => {}, true, () => monteCarlo.run(painter.renderer, painter.renderer.getRenderTarget() as THREE.WebGLRenderTarget));
    await painter.finish();
    await present(trueBall, pane.target.texture);
    await present(difference, bySplit.texture, pane.target.texture);
    return pane.count < k_frames;
}

async function present(canvas: HTMLCanvasElement, texture: THREE.Texture, other: THREE.Texture | null = null): Promise<void> {
    const u = show.uniforms;
    u.u_picture!.value = texture;
    u.u_other!.value = other;
    u.u_difference!.value = other !== null;
    await painter.paint(canvas, show, k_size, k_size);
}

/// The light of the chosen point by both.
async function drawPoint(): Promise<void> {
    shared.u_what!.value = 1;
    monteCarlo.uniforms.u_samples!.value = 16;
    monteCarlo.uniforms.u_frame!.value = 0;
    const truth = statistics(await painter.compute(monteCarlo, 1, 2048)), [r, g, b] = await painter.compute(split, 1, 1), approximate = luminance(r!, g!, b!), error = truth.deviation / Math.sqrt(truth.count);
    Object.assign(numbers, {split: approximate, truth: truth.mean, truthError: error});
    facts.set('Error of split-sum', percentWithError(approximate / truth.mean - 1, (error / truth.mean) * (approximate / truth.mean)));
    facts.set('By split-sum', digits(approximate));
    facts.set('By Monte Carlo', withError(truth.mean, error));
}

async function drawLobes(): Promise<void> {
    const {roughness, NdotV} = lesson.state, u = tables.uniforms;
    u.u_cosine!.value = NdotV;
    u.u_lobe_roughness!.value = roughness;
    for (const [canvas, what] of [[trueLobe, 2], [mapLobe, 3]] as const) {
        u.u_what!.value = what;
        await painter.paint(canvas, tables, k_size, k_size);
    }
}

/// How many samples the table was drawn with.
let tableCount = 0;
async function drawTable(): Promise<void> {
    const {count} = lesson.state, u = tables.uniforms;
    if (count === tableCount) return;
    u.u_count!.value = count;
    u.u_what!.value = 0;
    const values = await painter.compute(tables, k_table, k_table);
    let sum = 0;
    for (let k = 0; k < values.length; k += 4) for (const c of [0, 1]) sum += (values[k + c]! - exactTable![k + c]!) ** 2;
    numbers.tableError = Math.sqrt(sum / (2 * k_table * k_table));
    tableFacts.set('RMS error of A and B', digits(numbers.tableError));
    u.u_what!.value = 1;
    await painter.paint(sampled, tables, k_table, k_table);
    tableCount = count;
}
lesson.start();
