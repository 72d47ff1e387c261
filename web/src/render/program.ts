// How the text of a shader is put together.

import fullscreenVertex from '../shading/fullscreen_vertex.glsl?raw';

export interface Program {
    vertexShader: string;
    fragmentShader: string;
}

const head = 'precision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp samplerCube;\nprecision highp sampler2DArray;\n';
export const join = (...parts: string[]): string => head + parts.join('\n');

/// A shader that is run for each pixel.
export const fullscreen = (...parts: string[]): Program => ({vertexShader: join(fullscreenVertex), fragmentShader: join(...parts)});

/// The lat-long shaders have +Z up in the space of their map, so their u_environment is another matrix than that of the cubes.
export const ownFrame = (text: string): string => text.replaceAll('u_environment', 'u_envmap_frame');
