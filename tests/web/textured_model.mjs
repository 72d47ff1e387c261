// A model with everything that the shaders read: a ball with all five textures, and three lights.

import zlib from 'node:zlib';

/// A PNG of RGB bytes.
function png(size, colour) {
    const rows = Buffer.alloc(size * (1 + 3 * size));
    for (let y = 0; y < size; ++y)
        for (let x = 0; x < size; ++x) colour((x + 0.5) / size, (y + 0.5) / size).forEach((v, c) => (rows[y * (1 + 3 * size) + 1 + 3 * x + c] = Math.round(255 * v)));
    const chunk = (name, data) => {
        const body = Buffer.concat([Buffer.from(name), data]), out = Buffer.alloc(8 + body.length);
        out.writeUInt32BE(data.length, 0);
        body.copy(out, 4);
        out.writeUInt32BE(zlib.crc32 ? zlib.crc32(body) : crc32(body), 4 + body.length);
        return out;
    };
    const head = Buffer.alloc(13);
    head.writeUInt32BE(size, 0);
    head.writeUInt32BE(size, 4);
    head.set([8, 2, 0, 0, 0], 8);
    return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk('IHDR', head), chunk('IDAT', zlib.deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}
function crc32(bytes) {
    let crc = ~0;
    for (const byte of bytes) {
        crc ^= byte;
        for (let k = 0; k < 8; ++k) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
    }
    return ~crc >>> 0;
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
        png(128, (u, v) => [0.3 + 0.6 * wave(u, v, 2, 3), 0.5, 0.9 - 0.6 * wave(u, v, 2, 3)]),  // base colour
        png(128, (u, v) => [0, 0.15 + 0.7 * wave(u, v, 3, 2), wave(u, v, 1, 4)]),               // roughness, metalness
        png(256, bump), png(128, (u, v) => [0.4 + 0.6 * wave(u, v, 2, 5), 0, 0]), png(128, (u, v) => [0, 0.2 * wave(u, v, 4, 2) ** 4, 0]),
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
        bufferViews: views, buffers: [{byteLength: blob.length}],
    };
    const text = Buffer.from(JSON.stringify(document)), json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]), words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
    return Buffer.concat([words(0x46546c67, 2, 28 + json.length + blob.length, json.length, 0x4e4f534a), json, words(blob.length, 0x4e4942), blob]);
}
