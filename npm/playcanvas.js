// PlayCanvas: what scene.envAtlas takes, in place of EnvLighting.generateAtlas.

import {DomelightError, encode, fromPixels, prefilter, read} from './index.js';
import {mirroredX} from './pixels.js';
import {cubePixels, latlongPixels, withEnvironment} from './source.js';

/// Filters an environment exactly, in a worker.
///
/// scene      the Scene whose envAtlas it will be
/// source     a file (URL, File, Blob, Response, ArrayBuffer), a lat-long Texture of PlayCanvas, as its loader of .hdr files gives it, a cube Texture or a
///            RenderTarget of either kind, of floats, half floats or RGBE, or an Environment of this package
/// options    progress and signal; those of read() in `file`; and PlayCanvas itself in `pc`, of which Texture and its constants are used: where it is left
///            out, the global pc of a script
/// returns    a Texture of 512² texels in RGBP, whose maximum is 64. destroy() it as any other
export async function bakeEnvironment(scene, source, {file, pc = globalThis.pc, progress, signal, ...others} = {}) {
    if (!pc?.Texture) throw new DomelightError('has no Texture', 'pc', "Give {pc}, of import * as pc from 'playcanvas'.");
    for (const name of Object.keys(others)) throw new DomelightError('is not an option', name, 'Options: file, pc, progress, signal.');
    return withEnvironment(source, () => open(pc, source, {signal, ...file}), async environment => {
        const filtered = await prefilter(environment, {layout: 'latlong', levels: chain, irradianceSize: 64, progress, signal});
        const {levels} = await encode(atlas(filtered), {encoding: 'rgbp', signal});
        return new pc.Texture(scene.device, {
            name: 'domelight', width: side, height: side, format: pc.PIXELFORMAT_RGBA8, type: pc.TEXTURETYPE_RGBP, projection: pc.TEXTUREPROJECTION_EQUIRECT,
            addressU: pc.ADDRESS_CLAMP_TO_EDGE, addressV: pc.ADDRESS_CLAMP_TO_EDGE, minFilter: pc.FILTER_LINEAR, magFilter: pc.FILTER_LINEAR, mipmaps: false, levels: [levels[0].data],
        });
    });
}

function open(pc, source, options) {
    const texture = source?.colorBuffer ?? source;
    return texture?.impl && texture.device ? openTexture(pc, texture) : read(source, options);
}

/// A lat-long picture that PlayCanvas has loaded, +Z in its middle and -X to the right of that, or a cube, which it looks up by (-x, y, z).
async function openTexture(pc, texture) {
    const {width, height} = texture, rgbe = texture.type === pc.TEXTURETYPE_RGBE;
    if (!(rgbe || [pc.PIXELFORMAT_RGBA16F, pc.PIXELFORMAT_RGBA32F].includes(texture.format)))
        throw new DomelightError('The texture does not hold floats, half floats or RGBE', '', 'Give its file itself: read() decodes it.');
    const pixels = async face => {
        const data = await texture.read(0, 0, width, height, {immediate: true, face});
        return rgbe ? fromRgbe(data) : data;
    };
    if (!texture.cubemap) return fromPixels(latlongPixels({data: await pixels(), width, height}, true), {worldToSource: [0, 0, 1, 0, 1, 0, -1, 0, 0]});
    const faces = [];
    for (let face = 0; face < 6; ++face) faces.push(await pixels(face));
    return fromPixels(cubePixels(faces, width), {worldToSource: mirroredX});
}

/// As PlayCanvas decodes it.
function fromRgbe(bytes) {
    const rgb = new Float32Array((bytes.length / 4) * 3);
    for (let k = 0; k < bytes.length / 4; ++k) {
        const scale = bytes[4 * k + 3] ? 2 ** (bytes[4 * k + 3] - 128) / 255 : 0;
        for (let c = 0; c < 3; ++c) rgb[3 * k + c] = scale * bytes[4 * k + c];
    }
    return rgb;
}

// The atlas, as src/texture/container/playcanvas_atlas.h describes it.

const side = 512;
/// Level k is read at roughness k / 5. Each map is filtered at twice its height there.
const chain = Array.from({length: 7}, (_, k) => ({size: side >> k, roughness: Math.min(1, k / 5)}));

/// All maps in their places: {data, width, height} of RGB floats.
function atlas({levels, irradianceOverPi}) {
    const data = new Float32Array(3 * side * side);
    const put = (map, x, y, width) => putMap(data, map, {x, y, width, height: width / 2});
    // The environment in every size for mirrors, then the rougher ones, then E / π.
    for (let k = 0; k < 7; ++k) put(levels[0], side - (side >> k), side - (side >> k), side >> k);
    for (let k = 1; k < 7; ++k) put(levels[k], 0, side - (side >> k), side >> k);
    put(irradianceOverPi, 128, 384, 64);
    return {data, width: side, height: side};
}

/// A lat-long map in its place, turned so that +Z is in the centre. Its outermost texels are a seam, which continues over the edges: around the sphere at
/// the sides, and past the poles (half a turn away) above and below.
function putMap(atlas, map, {x: left, y: top, width: outer, height: outerHeight}) {
    const width = outer - 2, height = outerHeight - 2, inner = resized(map, width, height);
    for (let y = 0; y < outerHeight; ++y) {
        const pastPole = y === 0 || y === outerHeight - 1, row = Math.min(height - 1, Math.max(0, y - 1));
        for (let x = 0; x < outer; ++x) {
            const column = (x - 1 + width + (pastPole ? width / 2 : 0)) % width, at = 3 * (row * width + column);
            atlas.set(inner.subarray(at, at + 3), 3 * ((top + y) * side + left + x));
        }
    }
}

/// For each of `targets` texels the texels of `count` that it covers, with shares that sum to 1. `measure` grows along the axis.
function shares(count, targets, measure) {
    return Array.from({length: targets}, (_, t) => {
        const begin = t / targets, end = (t + 1) / targets, all = [];
        for (let i = Math.floor(begin * count); i < Math.min(count, Math.ceil(end * count)); ++i) {
            const a = Math.max(begin, i / count), b = Math.min(end, (i + 1) / count);
            if (b > a) all.push([i, (measure(b) - measure(a)) / (measure(end) - measure(begin))]);
        }
        return all;
    });
}

/// A lat-long map of RGB whose centre is +X as a smaller one whose centre is +Z, by the solid angles that texels share.
function resized({data, width, height}, newWidth, newHeight) {
    const columns = shares(width, newWidth, u => u), rows = shares(height, newHeight, v => -Math.cos(Math.PI * v));
    const out = new Float32Array(3 * newWidth * newHeight), row = new Float64Array(3 * width);
    rows.forEach((parts, y) => {
        row.fill(0);
        for (const [from, weight] of parts) for (let i = 0; i < row.length; ++i) row[i] += weight * data[3 * width * from + i];
        columns.forEach((list, x) => {
            for (const [from, weight] of list) {
                const at = 3 * ((from + width / 4) % width);
                for (let c = 0; c < 3; ++c) out[3 * (y * newWidth + x) + c] += weight * row[at + c];
            }
        });
    });
    return out;
}
