// The text of the shaders, put together from files: those of docs/shaders, which are tested against the C++, and those of shading/.

import generic from '../../../docs/shaders/generic.glsl?raw';
import sampleEnvmap from '../../../docs/shaders/sample_envmap.glsl?raw';
import sphericalEnvmap from '../../../docs/shaders/spherical_envmap.glsl?raw';
import accumulate from '../shading/accumulate.glsl?raw';
import backgroundFragment from '../shading/background_fragment.glsl?raw';
import backgroundVertex from '../shading/background_vertex.glsl?raw';
import bilinear from '../shading/bilinear.glsl?raw';
import diffuse from '../shading/diffuse.glsl?raw';
import environment from '../shading/environment.glsl?raw';
import identify from '../shading/identify.glsl?raw';
import level from '../shading/level.glsl?raw';
import lookup from '../shading/lookup.glsl?raw';
import material from '../shading/material.glsl?raw';
import metallicRoughness from '../shading/metallic_roughness.glsl?raw';
import mirror from '../shading/mirror.glsl?raw';
import modelFragment from '../shading/model_fragment.glsl?raw';
import modelVertex from '../shading/model_vertex.glsl?raw';
import monteCarlo from '../shading/monte_carlo.glsl?raw';
import phong from '../shading/phong.glsl?raw';
import present from '../shading/present.glsl?raw';
import probe from '../shading/probe.glsl?raw';
import projectEnvironment from '../shading/project_environment.glsl?raw';
import projections from '../shading/projections.glsl?raw';
import refract from '../shading/refract.glsl?raw';
import splitSum from '../shading/split_sum.glsl?raw';
import stretched from '../shading/stretched.glsl?raw';
import surface from '../shading/surface.glsl?raw';
import tonemap from '../shading/tonemap.glsl?raw';
import type {Mode} from '../state';
import {fullscreen, join, ownFrame, type Program} from './program';
import {stretchedFit} from './stretched_fit';

const sharp = [generic, environment, projections, lookup];
/// What computes a surface's light, by mode.
const lighting: Record<Mode, string[]> = {
    'split-sum': [generic, diffuse, metallicRoughness, splitSum],
    stretched: [generic, diffuse, metallicRoughness, stretchedFit(), stretched],
    phong: [generic, diffuse, phong],
    mirror: [...sharp, mirror],
    refract: [...sharp, refract],
    'monte-carlo': [ownFrame(sphericalEnvmap), sampleEnvmap, bilinear, monteCarlo],
};

/// What a model is drawn with: a method of shading, or what the page wants to know of a pixel.
export type Purpose = Mode | 'probe' | 'identify';

const fragments = (purpose: Purpose): string[] =>
    purpose === 'probe' ? [material, surface, probe] : purpose === 'identify' ? [identify] : [material, surface, ...lighting[purpose], modelFragment];

export const modelProgram = (purpose: Purpose): Program => ({vertexShader: join(modelVertex), fragmentShader: join(...fragments(purpose))});
export const backgroundProgram: Program = {
    vertexShader: join(backgroundVertex),
    fragmentShader: join(environment, generic, backgroundFragment),
};
export const projectProgram = fullscreen(environment, projections, projectEnvironment);
export const accumulateProgram = fullscreen(accumulate);
export const levelProgram = fullscreen(environment, generic, projections, tonemap, level);
export const presentProgram = fullscreen(tonemap, present);
