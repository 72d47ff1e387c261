// Decoders other than Domelight's: the GPU's for BC6H, and Basis Universal's for UASTC HDR.
import {read} from 'ktx-parse';
import {script} from './pixels.mjs';

export const version = 'WebGL 2';
const gl = document.createElement('canvas').getContext('webgl2');
gl.getExtension('EXT_color_buffer_float');
const bptc = gl.getExtension('EXT_texture_compression_bptc');

const bytes = async url => new Uint8Array(await (await fetch(url)).arrayBuffer());

function text(floats) {
    const out = new Uint8Array(floats.buffer);
    let s = '';
    for (let k = 0; k < out.length; k += 0x8000) s += String.fromCharCode(...out.subarray(k, k + 0x8000));
    return btoa(s);
}

/// Draws every texel of a square texture, as it is stored, into floats: RGBA, from the first row on.
const program = (() => {
    const shader = (type, source) => {
        const s = gl.createShader(type);
        gl.shaderSource(s, `#version 300 es\n${source}`);
        gl.compileShader(s);
        return s;
    };
    const p = gl.createProgram();
    gl.attachShader(p, shader(gl.VERTEX_SHADER, `void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4. - 1., 0, 1); }`));
    gl.attachShader(p, shader(gl.FRAGMENT_SHADER, `precision highp float; precision highp sampler2D; uniform sampler2D t; out vec4 c;
                                                   void main() { c = texelFetch(t, ivec2(gl_FragCoord.xy), 0); }`));
    gl.linkProgram(p);
    return p;
})();

function readBack(texture, size) {
    const target = gl.createTexture(), frame = gl.createFramebuffer(), floats = new Float32Array(4 * size * size);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, size, size);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.viewport(0, 0, size, size);
    gl.useProgram(program);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, floats);
    if (gl.getError()) throw new Error('reading back failed');
    gl.deleteTexture(target);
    gl.deleteFramebuffer(frame);
    return floats;
}

/// Levels of a BC6H cube in KTX2 without supercompression, read back from the GPU: RGBA floats, faces one after the other, as base64.
export async function decodeBc6h({url}) {
    if (!bptc) throw new Error('this GPU does not know BC6H');
    const file = read(await bytes(url));
    if (file.vkFormat !== 143) throw new Error(`VkFormat ${file.vkFormat} is not BC6H_UFLOAT_BLOCK`);
    return file.levels.map(({levelData}, level) => {
        const size = Math.max(1, file.pixelWidth >> level), length = 16 * Math.ceil(size / 4) ** 2, out = new Float32Array(24 * size * size);
        for (let face = 0; face < 6; ++face) {
            const texture = gl.createTexture();
            gl.bindTexture(gl.TEXTURE_2D, texture);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
            gl.compressedTexImage2D(gl.TEXTURE_2D, 0, bptc.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT, size, size, 0,
                                    levelData.subarray(face * length, (face + 1) * length));
            out.set(readBack(texture, size), 4 * face * size * size);
            gl.deleteTexture(texture);
        }
        return text(out);
    });
}

/// The same of a UASTC HDR 4x4 cube, by Basis Universal's transcoder as three.js ships it. It refuses a file that is not in its subset.
export async function decodeUastcHdr({url}) {
    await script('/npm/three/examples/jsm/libs/basis/basis_transcoder.js');
    const basis = await BASIS({locateFile: name => `/npm/three/examples/jsm/libs/basis/${name}`});
    basis.initializeBasis();
    const file = new basis.KTX2File(await bytes(url));
    if (!file.isValid() || !file.isHDR() || !file.startTranscoding()) throw new Error('Basis Universal does not take the file');
    const RGBA_HALF = 25, levels = [];
    const fromHalf = h => {
        const exponent = (h >> 10) & 31, mantissa = h & 1023;
        return exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -24 * mantissa;
    };
    for (let level = 0; level < file.getLevels(); ++level) {
        const size = Math.max(1, file.getWidth() >> level), out = new Float32Array(24 * size * size);
        for (let face = 0; face < 6; ++face) {
            const raw = new Uint8Array(file.getImageTranscodedSizeInBytes(level, 0, face, RGBA_HALF));
            if (!file.transcodeImage(raw, level, 0, face, RGBA_HALF, 0, -1, -1)) throw new Error(`level ${level}, face ${face} is refused`);
            out.set(Float32Array.from(new Uint16Array(raw.buffer), fromHalf), 4 * face * size * size);
        }
        levels.push(text(out));
    }
    return levels;
}
