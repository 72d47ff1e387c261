// A room with an open side, and boxes in it, as a .glb: all of it matte, so that only the diffuse light of probes shows.

import fs from 'node:fs';
import {glb} from './files.mjs';

/// The six sides of a box, outwards or inwards; `without`: the side to leave out, as axis and sign.
function box(low, high, inwards, without) {
    const positions = [], normals = [], triangles = [];
    for (let axis = 0; axis < 3; ++axis)
        for (const sign of [-1, 1]) {
            if (without && without[0] === axis && without[1] === sign) continue;
            const u = (axis + 1) % 3, v = (axis + 2) % 3, first = positions.length / 3;
            for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
                const point = [];
                point[axis] = sign > 0 ? high[axis] : low[axis];
                point[u] = a ? high[u] : low[u];
                point[v] = b ? high[v] : low[v];
                positions.push(...point);
                normals.push(...[0, 1, 2].map(k => (k === axis ? (inwards ? -sign : sign) : 0)));
            }
            const order = (sign > 0) !== inwards ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2];
            triangles.push(...order.map(k => first + k));
        }
    return {positions, normals, triangles};
}

const matte = colour => ({pbrMetallicRoughness: {baseColorFactor: [...colour, 1], metallicFactor: 0, roughnessFactor: 1},
                          extensions: {KHR_materials_ior: {ior: 1}, KHR_materials_specular: {specularFactor: 0}}});

/// The picture of it that the engines and Domelight draw.
export const roomScene = {file: 'room.glb', width: 256, height: 192, fovDeg: 50, eye: [0, 1.4, 5.6], target: [0, 1.2, 0], low: [-2, 0, -1.5], high: [2, 2.5, 1.5]};

export function writeRoom(folder) {
    const {low, high, file} = roomScene;
    const parts = [
        [box(low, high, true, [2, 1]), [0.7, 0.7, 0.7]],
        [box([-1.995, 0.01, -1.49], [-1.99, 2.49, 1.4], false), [0.7, 0.15, 0.1]],
        [box([0.3, 0.01, -0.9], [1.1, 1.2, -0.2], false), [0.2, 0.6, 0.25]],
        [box([-1.2, 0.01, -0.4], [-0.5, 0.7, 0.4], false), [0.8, 0.8, 0.8]],
    ];
    const chunks = [], views = [], accessors = [];
    const add = (array, type, target, more = {}) => {
        const bytes = Buffer.from(array.buffer);
        views.push({buffer: 0, byteOffset: chunks.reduce((n, c) => n + c.length, 0), byteLength: bytes.length, target});
        chunks.push(Buffer.concat([bytes, Buffer.alloc((4 - bytes.length % 4) % 4)]));
        const components = type === 'VEC3' ? 3 : 1;
        accessors.push({bufferView: views.length - 1, componentType: components === 3 ? 5126 : 5123, count: array.length / components, type, ...more});
        return accessors.length - 1;
    };
    const meshes = parts.map(([{positions, normals, triangles}], k) => {
        const bound = pick => [0, 1, 2].map(axis => pick(...positions.filter((_, i) => i % 3 === axis)));
        const floats = Float32Array.from(positions);
        return {primitives: [{attributes: {POSITION: add(floats, 'VEC3', 34962, {min: bound(Math.min).map(Math.fround), max: bound(Math.max).map(Math.fround)}),
                                           NORMAL: add(Float32Array.from(normals), 'VEC3', 34962)},
                              indices: add(Uint16Array.from(triangles), 'SCALAR', 34963), material: k}]};
    });
    const document = {
        asset: {version: '2.0'}, extensionsUsed: ['KHR_materials_specular', 'KHR_materials_ior'], scene: 0, scenes: [{nodes: parts.map((_, k) => k)}],
        nodes: parts.map((_, k) => ({mesh: k})), meshes, materials: parts.map(([, colour]) => matte(colour)), accessors, bufferViews: views,
    };
    fs.writeFileSync(`${folder}/${file}`, glb(document, Buffer.concat(chunks)));
}
