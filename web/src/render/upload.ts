// Large textures, handed to the graphics card in slices.

import type * as THREE from 'three';
import type {Backlog} from './backlog';

/// Of a slice: what is copied in a few milliseconds.
const k_slice_bytes = 2 ** 23;

/// Uploads a texture of RGBA half floats that has not been used yet.
export async function uploadInSlices(renderer: THREE.WebGLRenderer, texture: THREE.DataTexture, backlog: Backlog): Promise<void> {
    const {width, height} = texture.image, texels = texture.image.data as unknown as Uint16Array, gl = renderer.getContext() as WebGL2RenderingContext;
    const rows = Math.max(1, Math.floor(k_slice_bytes / (8 * width)));
    if (rows >= height) return;
    await backlog.emptied();
    texture.source.dataReady = false;  // only memory is given to it
    renderer.initTexture(texture);
    texture.source.dataReady = true;
    const {state} = renderer, handle = () => (renderer.properties.get(texture) as {__webglTexture?: WebGLTexture}).__webglTexture;
    for (let y = 0; y < height; y += rows) {
        backlog.mark();
        await backlog.emptied();
        if (gl.isContextLost() || !handle()) return;  // three.js uploads the whole when the context is back
        state.bindTexture(gl.TEXTURE_2D, handle()!);
        state.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
        state.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        state.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
        const count = Math.min(rows, height - y);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, y, width, count, gl.RGBA, gl.HALF_FLOAT, texels, 4 * width * y);
        state.unbindTexture();
    }
    backlog.mark();
}
