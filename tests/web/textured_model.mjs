// A model with everything that the shaders read: a ball with all five textures, and three lights.

import {glb, png} from '../engines/browser/files.mjs';

/// A square PNG whose pixels are colour(u, v), three values from 0 to 1.
function pictureOf(size, colour) {
    const rgb = Buffer.alloc(3 * size * size);
    for (let y = 0; y < size; ++y)
        for (let x = 0; x < size; ++x) colour((x + 0.5) / size, (y + 0.5) / size).forEach((v, c) => (rgb[3 * (y * size + x) + c] = Math.round(255 * v)));
    return png(size, size, rgb);
}

function ball(columns, rows) {
    const positions = [], normals = [], tangents = [], uvs = [], indices = [];
    for (let j = 0; j <= rows; ++j)
        for (let i = 0; i <= columns; ++i) {
            const phi = (2 * Math.PI * i) / columns, theta = (Math.PI * j) / rows, n = [Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)];
            positions.push(...n);
            normals.push(...n);
            tangents.push(Math.cos(phi), 0, -Math.sin(phi), 1);
            uvs.push(i / columns, j / rows);
            const a = j * (columns + 1) + i, b = a + columns + 1;
            if (j < rows && i < columns) indices.push(a, b, b + 1, a, b + 1, a + 1);
        }
    return {positions, normals, tangents, uvs, indices};
}

/// The bytes of a .glb.
export function texturedModel() {
    const {positions, normals, tangents, uvs, indices} = ball(96, 48), wave = (u, v, m, n) => 0.5 + 0.5 * Math.sin(2 * Math.PI * m * u) * Math.sin(Math.PI * n * v);
    const bump = (u, v) => {
        const x = 0.15 * Math.cos(2 * Math.PI * 6 * u), y = 0.15 * Math.cos(2 * Math.PI * 4 * v), z = Math.sqrt(1 - x * x - y * y);
        return [0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z];
    };
    const pictures = [
        pictureOf(128, (u, v) => [0.3 + 0.6 * wave(u, v, 2, 3), 0.5, 0.9 - 0.6 * wave(u, v, 2, 3)]),  // base colour
        pictureOf(128, (u, v) => [0, 0.15 + 0.7 * wave(u, v, 3, 2), wave(u, v, 1, 4)]),               // roughness, metalness
        pictureOf(256, bump), pictureOf(128, (u, v) => [0.4 + 0.6 * wave(u, v, 2, 5), 0, 0]), pictureOf(128, (u, v) => [0, 0.2 * wave(u, v, 4, 2) ** 4, 0]),
    ];
    const parts = [Float32Array.from(positions), Float32Array.from(normals), Float32Array.from(tangents), Float32Array.from(uvs), Uint16Array.from(indices)]
        .map(array => Buffer.from(array.buffer)).concat(pictures);
    const pad = part => Buffer.concat([part, Buffer.alloc(-part.length & 3)]), blob = Buffer.concat(parts.map(pad));
    let offset = 0;
    const views = parts.map(part => {
        const view = {buffer: 0, byteOffset: offset, byteLength: part.length};
        offset += pad(part).length;
        return view;
    });
    const count = positions.length / 3, floats = (bufferView, type) => ({bufferView, componentType: 5126, count, type});
    const turned = (x, y) => [Math.sin(x / 2) * Math.cos(y / 2), Math.cos(x / 2) * Math.sin(y / 2), -Math.sin(x / 2) * Math.sin(y / 2), Math.cos(x / 2) * Math.cos(y / 2)];
    const document = {
        asset: {version: '2.0', extras: {lux_per_unit: 1}}, scene: 0, scenes: [{nodes: [0, 1, 2, 3]}],
        extensionsUsed: ['KHR_lights_punctual'],
        extensions: {KHR_lights_punctual: {lights: [
            {type: 'directional', color: [1, 0.9, 0.8], intensity: 0.8}, {type: 'point', color: [0.4, 0.6, 1], intensity: 4, range: 4},
            {type: 'spot', color: [1, 0.5, 0.3], intensity: 12, spot: {innerConeAngle: 0.1, outerConeAngle: 0.3}},
        ]}},
        nodes: [{mesh: 0, name: 'ball'}, {extensions: {KHR_lights_punctual: {light: 0}}, rotation: turned(-0.7, 0.5)},
                {extensions: {KHR_lights_punctual: {light: 1}}, translation: [1.2, 0.9, 1.3]}, {extensions: {KHR_lights_punctual: {light: 2}}, translation: [-0.4, 0.3, 3]}],
        meshes: [{primitives: [{attributes: {POSITION: 0, NORMAL: 1, TANGENT: 2, TEXCOORD_0: 3}, indices: 4, material: 0}]}],
        accessors: [{...floats(0, 'VEC3'), min: [-1, -1, -1], max: [1, 1, 1]}, floats(1, 'VEC3'), floats(2, 'VEC4'), floats(3, 'VEC2'),
                    {bufferView: 4, componentType: 5123, count: indices.length, type: 'SCALAR'}],
        materials: [{pbrMetallicRoughness: {baseColorTexture: {index: 0}, metallicRoughnessTexture: {index: 1}}, normalTexture: {index: 2},
                     occlusionTexture: {index: 3}, emissiveTexture: {index: 4}, emissiveFactor: [1, 1, 1]}],
        textures: pictures.map((_, source) => ({source})), images: pictures.map((_, k) => ({bufferView: 5 + k, mimeType: 'image/png'})),
        bufferViews: views,
    };
    return glb(document, blob);
}
