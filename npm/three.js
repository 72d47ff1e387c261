// three.js, r187 and later: what scene.environment takes, in place of PMREMGenerator.

import {CompressedCubeTexture, FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, LinearSRGBColorSpace, REVISION, RGBAFormat} from 'three';
import {bake, DomelightError, fromPixels, read} from './index.js';
import {mirroredX} from './pixels.js';
import {cubePixels, latlongPixels, withEnvironment} from './source.js';

/// Filters an environment exactly, in a worker.
///
/// renderer   the WebGLRenderer; only asked for pixels where `source` is a render target, otherwise it may be null
/// source     a file (URL, File, Blob, Response, ArrayBuffer), an equirectangular DataTexture as the loaders of three.js give it, a CubeTexture of floats or
///            half floats, such as that of HDRCubeTextureLoader, a WebGLCubeRenderTarget, an equirectangular WebGLRenderTarget, or an Environment of this package
/// options    those of bake(): size (512, as PMREMGenerator makes of a picture 2048 wide), levels, progress, signal, ...; and those of read() in `file`
/// returns    a texture for scene.environment. dispose() it as any other
export async function bakeEnvironment(renderer, source, {file, ...options} = {}) {
    if (Number.parseInt(REVISION, 10) < 187)
        throw new DomelightError(`three.js r${REVISION} reads another layout of filtered environments than cubes with levels`, '', 'r187 or later is needed.');
    return withEnvironment(source, () => open(renderer, source, {signal: options.signal, ...file}), async environment => {
        const texture = cubeTexture(await bake(environment, {...options, engine: 'three', encoding: 'rgba16f', layout: 'cube'}));
        texture.name = environment.name ?? 'PMREM';
        return texture;
    });
}

function open(renderer, source, options) {
    if (source?.isWebGLCubeRenderTarget) return fromPixels(cubeOfTarget(renderer, source));
    if (source?.isRenderTarget) return fromPixels(latlongPixels({data: readTarget(renderer, source), width: source.width, height: source.height}, false));
    if (source?.isCubeTexture) return fromPixels(cubeOfTexture(source), {worldToSource: mirroredX});
    if (source?.isTexture) return fromPixels(pixelsOf(source));
    return read(source, options);
}

function pixelsOf(texture) {
    const {image} = texture;
    if (!image?.data) throw new DomelightError('The texture has no pixels in memory', '', 'Give the file itself, a texture of HDRLoader or EXRLoader, or the render target.');
    // three.js gives the first row to the graphics processor as the lowest, unless the texture says flipY.
    return latlongPixels(image, texture.flipY);
}

/// A cube of pictures in memory. Its loaders give one DataTexture for each face.
function cubeOfTexture(texture) {
    const images = texture.images.map(image => image?.image ?? image), {width, height} = images[0] ?? {};
    if (images.length !== 6 || !images.every(image => image?.data && image.width === width && image.height === width))
        throw new DomelightError('The cube texture has no six square faces of pixels in memory', '', 'Give its file, or the render target that it was drawn into.');
    return cubePixels(images.map(({data}) => data), width);
}

/// Pixels that three.js has drawn, the lowest row first.
function readTarget(renderer, target, face) {
    const count = 4 * target.width * target.height, {type} = target.texture;
    if (type !== HalfFloatType && type !== FloatType) throw new DomelightError('The render target has neither floats nor half floats', '', 'Its `type` is HalfFloatType or FloatType.');
    const pixels = type === HalfFloatType ? new Uint16Array(count) : new Float32Array(count);
    renderer.readRenderTargetPixels(target, 0, 0, target.width, target.height, pixels, face);
    return pixels;
}

/// A cube that three.js has drawn, for instance by a CubeCamera.
function cubeOfTarget(renderer, target) {
    return cubePixels(Array.from({length: 6}, (_, face) => readTarget(renderer, target, face)), target.width);
}

function cubeTexture({levels}) {
    const faces = Array.from({length: 6}, (_, f) => ({
        width: levels[0].width, height: levels[0].height,
        mipmaps: levels.map(({data, width, height}) => {
            const halves = width * height * 4;
            return {data: new Uint16Array(data.buffer, data.byteOffset + 2 * f * halves, halves), width, height};
        }),
    }));
    const texture = new CompressedCubeTexture(faces, RGBAFormat, HalfFloatType);
    Object.assign(texture, {
        minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter, generateMipmaps: false, colorSpace: LinearSRGBColorSpace, isPMREMTexture: true,
        needsUpdate: true,
    });
    return texture;
}
