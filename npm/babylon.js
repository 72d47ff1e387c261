// Babylon.js: what scene.environmentTexture takes, in place of HDRCubeTexture and of files that were prefiltered before.

import {bake, DomelightError, fromPixels, read} from './index.js';
import {mirroredX} from './pixels.js';
import {cubePixels, withEnvironment} from './source.js';

/// Babylon's constants TEXTUREFORMAT_RGBA, TEXTURETYPE_FLOAT, TEXTURETYPE_HALF_FLOAT and TEXTURE_TRILINEAR_SAMPLINGMODE.
const rgba = 5, floats = 1, halves = 2, trilinear = 3;

/// Filters an environment exactly, in a worker.
///
/// scene      the Scene whose environmentTexture it will be
/// source     a file (URL, File, Blob, Response, ArrayBuffer), a cube texture of floats or half floats, or an Environment of this package
/// options    those of bake(): size (256, a power of two), progress, signal, ...; those of read() in `file`; and Babylon itself in `BABYLON`, of which
///            RawCubeTexture and SphericalPolynomial are used: where it is left out, the global BABYLON of a script
/// returns    a RawCubeTexture. dispose() it as any other
export async function bakeEnvironment(scene, source, {file, BABYLON = globalThis.BABYLON, ...options} = {}) {
    if (!BABYLON?.RawCubeTexture || !BABYLON.SphericalPolynomial)
        throw new DomelightError('has no RawCubeTexture and SphericalPolynomial', 'BABYLON', "Give {BABYLON}, of import * as BABYLON from '@babylonjs/core'.");
    const {size = 256} = options;
    if (!(Number.isInteger(Math.log2(size)) && size >= 1)) throw new DomelightError(`${size} is not a power of two`, 'size');
    // Babylon's graphics processor wants every level down to 1².
    const fixed = {engine: 'babylon', encoding: 'rgba16f', layout: 'cube', levels: Math.log2(size) + 1, shBands: 3};
    return withEnvironment(source, () => open(scene, source, {signal: options.signal, ...file}), async environment =>
        cubeTexture(BABYLON, scene, await bake(environment, {...options, ...fixed})));
}

function open(scene, source, options) {
    return typeof source?.getInternalTexture === 'function' ? openTexture(scene, source) : read(source, options);
}

/// A cube that Babylon has loaded or drawn.
async function openTexture(scene, texture) {
    const {type} = texture.getInternalTexture() ?? {};
    if (!texture.isCube || !texture.isReady() || texture.isRGBD || (type !== floats && type !== halves))
        throw new DomelightError('The texture is not a cube of floats that is ready', '', 'Give its file itself: read() decodes it.');
    // Of a right-handed scene the cube is half a turn off, unless it is turned back.
    const right = scene.useRightHandedSystem, half = Math.abs((texture.rotationY ?? 0) / Math.PI);
    if (half !== 0 && half !== 1) throw new DomelightError(`The texture is turned by ${texture.rotationY}`, '', 'A turn of the light is rotateYDeg of read().');
    const mirrored = right === (half === 1) ? mirroredX : [1, 0, 0, 0, 1, 0, 0, 0, -1];
    const {width} = texture.getSize(), faces = [];
    for (let face = 0; face < 6; ++face) faces.push(await texture.readPixels(face, 0));
    return fromPixels(cubePixels(faces, width), {worldToSource: mirrored});
}

function cubeTexture({RawCubeTexture, SphericalPolynomial}, scene, {levels, sh}) {
    const size = levels[0].width, engine = scene.getEngine();
    const texture = new RawCubeTexture(scene, null, size, rgba, halves, true, false, trilinear);
    levels.forEach(({data, width}, level) => {
        const count = 4 * width * width;
        for (let face = 0; face < 6; ++face)
            engine._uploadArrayBufferViewToTexture(texture.getInternalTexture(), new Uint16Array(data.buffer, data.byteOffset + 2 * face * count, count), face, level);
    });
    texture.name = 'domelight';
    texture.gammaSpace = false;
    texture.lodGenerationScale = 0.8;
    texture.sphericalPolynomial = SphericalPolynomial.FromArray(polynomial(sh));
    if (scene.useRightHandedSystem) texture.rotationY = Math.PI;
    return texture;
}

/// The terms x y z xx yy zz yz zx xy of E / π, convolved with the clamped cosine once more: Babylon turns them back into harmonics and divides by the
/// factors of one convolution. `sh`: nine coefficients of the radiance in Babylon's world. Ramamoorthi and Hanrahan 2001, eq. 3.
function polynomial(sh) {
    const c = k => {
        const factor = [1, 2 / 3, 1 / 4][Math.floor(Math.sqrt(k))] ** 2;
        return [0, 1, 2].map(i => factor * sh[3 * k + i]);
    };
    const sum = (...terms) => [0, 1, 2].map(i => terms.reduce((s, [weight, v]) => s + weight * v[i], 0));
    const c0 = Math.sqrt(1 / (4 * Math.PI)), c1 = Math.sqrt(3 / (4 * Math.PI)), c2 = Math.sqrt(15 / (4 * Math.PI)), c20 = Math.sqrt(5 / (16 * Math.PI));
    return [
        sum([c1, c(3)]), sum([c1, c(1)]), sum([c1, c(2)]),
        sum([c0, c(0)], [-c20, c(6)], [c2 / 2, c(8)]), sum([c0, c(0)], [-c20, c(6)], [-c2 / 2, c(8)]), sum([c0, c(0)], [2 * c20, c(6)]),
        sum([c2, c(5)]), sum([c2, c(7)]), sum([c2, c(4)]),
    ];
}
