// three.js, r187 and later: what scene.environment takes, in place of PMREMGenerator.

import {CompressedCubeTexture, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, LinearSRGBColorSpace, REVISION, RGBAFormat} from 'three';
import {bake, DomelightError, fromPixels, read} from './index.js';
import {cubePixels, latlongPixels, withEnvironment} from './source.js';

/// Filters an environment exactly, in a worker.
///
/// renderer   the WebGLRenderer; only asked for pixels where `source` is a render target, otherwise it may be null
/// source     a file (URL, File, Blob, Response, ArrayBuffer), an equirectangular DataTexture as the loaders of three.js give it, a WebGLCubeRenderTarget
///            or its texture's `renderTarget`, or an Environment of this package
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
    if (source?.isTexture) return fromPixels(pixelsOf(source));
    return read(source, options);
}

function pixelsOf(texture) {
    if (texture.isCubeTexture) throw new DomelightError('Cube textures are read from render targets, or from their files: give one of these');
    const {image} = texture;
    if (!image?.data) throw new DomelightError('The texture has no pixels in memory', '', 'Give the file itself, or a texture of HDRLoader or EXRLoader.');
    // three.js gives the first row to the graphics processor as the lowest, unless the texture says flipY.
    return latlongPixels(image, texture.flipY);
}

/// A cube that three.js has drawn, for instance by a CubeCamera.
function cubeOfTarget(renderer, target) {
    const size = target.width, half = target.texture.type === HalfFloatType;
    const faces = Array.from({length: 6}, (_, face) => {
        const pixels = half ? new Uint16Array(4 * size * size) : new Float32Array(4 * size * size);
        renderer.readRenderTargetPixels(target, 0, 0, size, size, pixels, face);
        return pixels;
    });
    return cubePixels(faces, size);
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
