// The scenes that every engine and Domelight's own renderer draw: spheres, as .glb files.

import fs from 'node:fs';
import {glb} from './files.mjs';

/// Positions, normals and triangles of a sphere about the origin; `rings` from pole to pole and twice as many sectors.
function sphere(radius, rings) {
    const sectors = 2 * rings, normals = [], triangles = [];
    for (let i = 0; i <= rings; ++i)
        for (let j = 0; j <= sectors; ++j) {
            const theta = Math.PI * i / rings, phi = 2 * Math.PI * j / sectors;
            normals.push(Math.sin(theta) * Math.cos(phi), Math.cos(theta), -Math.sin(theta) * Math.sin(phi));
        }
    for (let i = 0; i < rings; ++i)
        for (let j = 0; j < sectors; ++j) {
            const a = i * (sectors + 1) + j, b = a + sectors + 1;
            if (i > 0) triangles.push(a, b, a + 1);
            if (i < rings - 1) triangles.push(a + 1, b, b + 1);
        }
    return {positions: Float32Array.from(normals, n => n * radius), normals: Float32Array.from(normals), triangles: Uint16Array.from(triangles)};
}

/// Writes a .glb: one sphere a material, at its `centre`.
function writeGlb(path, radius, rings, balls) {
    const mesh = sphere(radius, rings);
    const parts = [mesh.positions, mesh.normals, mesh.triangles].map(a => Buffer.from(a.buffer));
    const offsets = [0, parts[0].length, parts[0].length + parts[1].length];
    const bound = Array(3).fill(radius);
    const document = {
        asset: {version: '2.0'},
        extensionsUsed: ['KHR_materials_specular', 'KHR_materials_ior'],
        scene: 0,
        scenes: [{nodes: balls.map((_, k) => k)}],
        nodes: balls.map((ball, k) => ({mesh: k, translation: ball.centre})),
        meshes: balls.map((_, k) => ({primitives: [{attributes: {POSITION: 0, NORMAL: 1}, indices: 2, material: k}]})),
        materials: balls.map(ball => ball.material),
        accessors: [
            {bufferView: 0, componentType: 5126, count: mesh.positions.length / 3, type: 'VEC3', min: bound.map(b => -b), max: bound},
            {bufferView: 1, componentType: 5126, count: mesh.normals.length / 3, type: 'VEC3'},
            {bufferView: 2, componentType: 5123, count: mesh.triangles.length, type: 'SCALAR'},
        ],
        bufferViews: parts.map((part, k) => ({buffer: 0, byteOffset: offsets[k], byteLength: part.length, target: k < 2 ? 34962 : 34963})),
    };
    fs.writeFileSync(path, glb(document, Buffer.concat(parts)));
}

const metal = roughness => ({pbrMetallicRoughness: {baseColorFactor: [1, 1, 1, 1], metallicFactor: 1, roughnessFactor: roughness}});
const plastic = roughness => ({pbrMetallicRoughness: {baseColorFactor: [0.5, 0.5, 0.5, 1], metallicFactor: 0, roughnessFactor: roughness}});
// An index of refraction of 1 and a specular weight of 0: whichever of the two an engine supports, only diffuse light is left.
const lambert = {pbrMetallicRoughness: {baseColorFactor: [1, 1, 1, 1], metallicFactor: 0, roughnessFactor: 1},
                 extensions: {KHR_materials_ior: {ior: 1}, KHR_materials_specular: {specularFactor: 0}}};

/// One mirror ball of radius 1 at the origin, seen from a corner of the room, so that it shows all six axes.
export const mirrorScene = {
    file: 'mirror.glb', width: 256, height: 256, fovDeg: 20, target: [0, 0, 0],
    eye: [1, 0.8, 1.3].map(x => 6 * x / Math.hypot(1, 0.8, 1.3)),
    balls: [{name: 'mirror', centre: [0, 0, 0], material: metal(0)}], radius: 1, rings: 80,
};

export const roughnesses = [0, 0.25, 0.5, 0.75, 1];

/// White metals of five roughnesses, and below them white Lambert and two grey plastics, seen from +Z.
export const ballsScene = {
    file: 'balls.glb', width: 320, height: 128, fovDeg: 2 * Math.atan(2 / 20) * 180 / Math.PI, target: [0, 0, 0], eye: [0, 0, 20],
    balls: [
        ...roughnesses.map((roughness, k) => ({name: `metal ${roughness}`, roughness, centre: [2 * k - 4, 1, 0], material: metal(roughness)})),
        {name: 'lambert', centre: [-4, -1, 0], material: lambert},
        {name: 'plastic 0.25', centre: [-2, -1, 0], material: plastic(0.25)},
        {name: 'plastic 0.75', centre: [0, -1, 0], material: plastic(0.75)},
    ],
    radius: 0.9, rings: 40,
};

export const writeScene = (folder, scene) => writeGlb(`${folder}/${scene.file}`, scene.radius, scene.rings, scene.balls);

// What a pixel of a scene sees, computed by plain geometry.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const add = (a, b, t) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
const unit = a => a.map(x => x / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/// The ball at point (x, y) of the picture, in pixels from the upper left corner: {ball, normal, toEye, reflected}, or null outside all balls.
export function look(scene, x, y) {
    const forward = unit(add(scene.target, scene.eye, -1));
    const right = unit(cross(forward, [0, 1, 0])), up = cross(right, forward);
    const half = Math.tan(scene.fovDeg * Math.PI / 360);
    const direction = unit(add(add(forward, right, (2 * x / scene.width - 1) * half * scene.width / scene.height), up, (1 - 2 * y / scene.height) * half));
    for (let ball = 0; ball < scene.balls.length; ++ball) {
        const toEye = add(scene.eye, scene.balls[ball].centre, -1);
        const b = dot(toEye, direction), discriminant = b * b - dot(toEye, toEye) + scene.radius ** 2;
        if (discriminant <= 0) continue;
        const normal = unit(add(toEye, direction, -b - Math.sqrt(discriminant)));
        return {ball, normal, NdotV: -dot(normal, direction), reflected: add(direction, normal, -2 * dot(direction, normal))};
    }
    return null;
}

/// The place in a lat-long picture where a direction points: [x, y] in pixels. Centre +X, right +Z, top +Y.
export function latlongPixel(image, d) {
    return [(0.5 + Math.atan2(d[2], d[0]) / (2 * Math.PI)) * image.width, Math.atan2(Math.hypot(d[0], d[2]), d[1]) / Math.PI * image.height];
}
