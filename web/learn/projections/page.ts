// One direction in five projections.

import * as THREE from 'three';
import {Pass} from '../../src/render/passes';
import {fullscreen} from '../../src/render/program';
import environment from '../../src/shading/environment.glsl?raw';
import projections from '../../src/shading/projections.glsl?raw';
import {element} from '../../src/ui/controls';
import {showCode} from '../common/code';
import {directionControls, directionOf, drawMark, onDrag, vectorOf} from '../common/direction';
import {Facts, figure, fill, Lesson, picture} from '../common/lesson';
import {mapParts} from '../common/maps';
import locate from './locate.glsl?raw';

const usual = {environment: 'studio', azimuth: 48, elevation: 38};
const lesson = new Lesson(usual), {light, painter, values, numbers} = lesson;
const maps = [
    {name: 'Lat-long', width: 720, height: 360}, {name: 'Cube: +X −X +Y above, −Y +Z −Z below', width: 600, height: 400}, {name: 'Sphere map, centre +Z', width: 400, height: 400},
    {name: 'Dual paraboloid: front +Z, back −Z', width: 720, height: 360}, {name: 'Octahedral, centre +Y', width: 400, height: 400},
];
const pass = new Pass(fullscreen(...mapParts, projections, locate), {
    ...light.uniforms, u_projection: {value: 0}, u_what: {value: 0}, u_point: {value: new THREE.Vector2()}, u_direction: {value: new THREE.Vector3()},
}), u = pass.uniforms;

const facts = new Facts(), rows = element('tbody');
const shown = maps.map(({name}, projection) => {
    const canvas = picture(`${name}: the environment with the chosen direction`);
    canvas.classList.add('aimed', 'discs');
    onDrag(canvas, place => point(projection, place), true);
    return {canvas, still: element('canvas')};
});
// The wide ones above, the square ones below.
fill('maps', ...[0, 3, 1, 2, 4].map(k => figure(shown[k]!.canvas, maps[k]!.name)));
fill('controls', ...directionControls(values, 'Direction'));
fill('facts', facts.root, element('table', {}, element('caption', {className: 'sr'}, 'The direction in each map'),
    element('thead', {}, element('tr', {}, ...['Map', 'u', 'v', 'Solid angle / 4π per area'].map(text => element('th', {scope: 'col'}, text)))), rows));
showCode('code', 'web/src/shading/environment.glsl and projections.glsl', environment + projections, 'latlong_point', 'sphere_map_uv', 'paraboloid_uv', 'octahedral_fold', 'octahedral_uv', 'faces_uv');

/// The point of a map under the pointer, whose direction the next drawing chooses.
let pointed: {projection: number; point: [number, number]} | undefined;
function point(projection: number, point: [number, number]): void {
    pointed = {projection, point};
    lesson.draw();
}
/// The direction under the pointer, by the shader that draws the map.
async function choose(): Promise<void> {
    if (!pointed) return;
    u.u_what!.value = 1;
    u.u_projection!.value = pointed.projection;
    (u.u_point!.value as THREE.Vector2).fromArray(pointed.point);
    pointed = undefined;
    const [x, y, z, isShown] = await painter.compute(pass, 1, 1);
    if (isShown) values.set(directionOf([x!, y!, z!]));
}

/// Which light the pictures show.
let pictured: unknown;
async function drawPictures(): Promise<void> {
    const {tables} = light;
    if (pictured === tables) return;
    for (const [projection, {still}] of shown.entries()) {
        u.u_what!.value = 0;
        u.u_projection!.value = projection;
        await painter.paint(still, pass, maps[projection]!.width, maps[projection]!.height);
    }
    pictured = tables;
}

lesson.onDraw(async () => {
    await choose();
    await drawPictures();
    const direction = vectorOf(lesson.state), [x, y, z] = direction;
    u.u_what!.value = 2;
    (u.u_direction!.value as THREE.Vector3).fromArray(direction);
    const table = await painter.compute(pass, maps.length, 1), lines: HTMLElement[] = [];
    maps.forEach(({name, width, height}, k) => {
        const {canvas, still} = shown[k]!, [a, b, spread] = table.subarray(4 * k) as unknown as [number, number, number];
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
        const context = canvas.getContext('2d')!;
        context.clearRect(0, 0, width, height);
        context.drawImage(still, 0, 0);
        drawMark(context, [a, b]);
        lines.push(element('tr', {}, element('th', {scope: 'row'}, name.split(/[:,]/)[0]!), ...[a, b, spread].map(v => element('td', {}, v.toFixed(3)))));
        numbers[`u${k}`] = a;
        numbers[`v${k}`] = b;
        numbers[`spread${k}`] = spread;
    });
    rows.replaceChildren(...lines);
    facts.set('Direction (x, y, z)', [x, y, z].map(v => v.toFixed(3).replace('-', '−')).join('  '));
});
lesson.start();
