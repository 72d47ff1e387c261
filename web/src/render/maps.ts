// The maps of a bake as textures.

import * as THREE from 'three';
import type {BrdfTable, Chain, CubeLevel, EnvironmentInfo} from '../bake/types';

/// A cube whose levels are all given. (A CompressedCubeTexture takes its levels as they are, which a CubeTexture does not.)
export function cubeTexture(levels: CubeLevel[]): THREE.CompressedCubeTexture {
    const faces = Array.from({length: 6}, (_, face) => ({
        width: levels[0]!.size,
        height: levels[0]!.size,
        format: THREE.RGBAFormat,
        mipmaps: levels.map(({size, texels}) => ({
            width: size,
            height: size,
            data: texels.subarray(face * size * size * 4, (face + 1) * size * size * 4),
        })),
    }));
    const texture = new THREE.CompressedCubeTexture(faces as never, THREE.RGBAFormat as never, THREE.HalfFloatType);
    texture.minFilter = levels.length > 1 ? THREE.LinearMipmapLinearFilter : THREE.LinearFilter;
    texture.magFilter = THREE.LinearFilter;
    texture.generateMipmaps = false;
    texture.needsUpdate = true;
    return texture;
}

export const chainTexture = (chain: Chain): THREE.CompressedCubeTexture => cubeTexture(chain.levels);

export function brdfTexture(table: BrdfTable): THREE.DataTexture {
    const texture = new THREE.DataTexture(table.texels, table.size, table.size, THREE.RGBAFormat, THREE.HalfFloatType);
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

/// A lat-long map of half floats, first row at v = 0. It repeats in u.
export function latlongTexture({width, height, texels}: EnvironmentInfo): THREE.DataTexture {
    const texture = new THREE.DataTexture(texels, width, height, THREE.RGBAFormat, THREE.HalfFloatType);
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.wrapS = THREE.RepeatWrapping;
    texture.needsUpdate = true;
    return texture;
}

/// A table of floats that is read texel by texel.
export function tableTexture(values: Float32Array, width: number, height: number): THREE.DataTexture {
    const channels = values.length / (width * height);
    const format = channels === 1 ? THREE.RedFormat : channels === 2 ? THREE.RGFormat : THREE.RGBAFormat;
    const texture = new THREE.DataTexture(values, width, height, format, THREE.FloatType);
    texture.needsUpdate = true;
    return texture;
}
