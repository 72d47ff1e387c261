// The text of the shaders, put together from files: those of docs/shaders, which are tested against the C++, and those of shading/.

import generic from '../../../docs/shaders/generic.glsl?raw';
import accumulate from '../shading/accumulate.glsl?raw';
import backgroundFragment from '../shading/background_fragment.glsl?raw';
import backgroundVertex from '../shading/background_vertex.glsl?raw';
import environment from '../shading/environment.glsl?raw';
import fullscreenVertex from '../shading/fullscreen_vertex.glsl?raw';
import modelFragment from '../shading/model_fragment.glsl?raw';
import modelVertex from '../shading/model_vertex.glsl?raw';
import present from '../shading/present.glsl?raw';
import splitSum from '../shading/split_sum.glsl?raw';
import surface from '../shading/surface.glsl?raw';
import tonemap from '../shading/tonemap.glsl?raw';
import type {Mode} from '../state';

const head = 'precision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp samplerCube;\n';
const join = (...parts: string[]) => head + parts.join('\n');

/// What computes a surface's light, by mode.
const lighting: Record<Mode, string[]> = {
    'split-sum': [generic, splitSum],
    stretched: [generic, splitSum],
    phong: [generic, splitSum],
    mirror: [generic, splitSum],
    refract: [generic, splitSum],
    'monte-carlo': [generic, splitSum],
};

export interface Program {
    vertexShader: string;
    fragmentShader: string;
}

export const modelProgram = (mode: Mode): Program => ({
    vertexShader: join(modelVertex),
    fragmentShader: join(surface, ...lighting[mode], modelFragment),
});
export const backgroundProgram: Program = {
    vertexShader: join(backgroundVertex),
    fragmentShader: join(environment, generic, backgroundFragment),
};
const fullscreen = (...parts: string[]): Program => ({vertexShader: join(fullscreenVertex), fragmentShader: join(...parts)});
export const accumulateProgram = fullscreen(accumulate);
export const presentProgram = fullscreen(tonemap, present);
