// The text of the shaders, put together from files: those of docs/shaders, which are tested against the C++, and those of shading/.

import generic from '../../../docs/shaders/generic.glsl?raw';
import sampleEnvmap from '../../../docs/shaders/sample_envmap.glsl?raw';
import sphericalEnvmap from '../../../docs/shaders/spherical_envmap.glsl?raw';
import accumulate from '../shading/accumulate.glsl?raw';
import backgroundFragment from '../shading/background_fragment.glsl?raw';
import backgroundVertex from '../shading/background_vertex.glsl?raw';
import bilinear from '../shading/bilinear.glsl?raw';
import brdf from '../shading/brdf.glsl?raw';
import diffuse from '../shading/diffuse.glsl?raw';
import environment from '../shading/environment.glsl?raw';
import identify from '../shading/identify.glsl?raw';
import level from '../shading/level.glsl?raw';
import lights from '../shading/lights.glsl?raw';
import lookup from '../shading/lookup.glsl?raw';
import material from '../shading/material.glsl?raw';
import metallicRoughness from '../shading/metallic_roughness.glsl?raw';
import mirror from '../shading/mirror.glsl?raw';
import modelFragment from '../shading/model_fragment.glsl?raw';
import modelVertex from '../shading/model_vertex.glsl?raw';
import monteCarlo from '../shading/monte_carlo.glsl?raw';
import phong from '../shading/phong.glsl?raw';
import phongChain from '../shading/phong_chain.glsl?raw';
import phongProbes from '../shading/phong_probes.glsl?raw';
import present from '../shading/present.glsl?raw';
import presentExtended from '../shading/present_extended.glsl?raw';
import presentWhite from '../shading/present_white.glsl?raw';
import probe from '../shading/probe.glsl?raw';
import probeBallFragment from '../shading/probe_ball_fragment.glsl?raw';
import probeBallVertex from '../shading/probe_ball_vertex.glsl?raw';
import probeBlend from '../shading/probe_blend.glsl?raw';
import probeCells from '../shading/probe_cells.glsl?raw';
import probeLight from '../shading/probe_light.glsl?raw';
import probeRecords from '../shading/probe_records.glsl?raw';
import probeVisibility from '../shading/probe_visibility.glsl?raw';
import projectEnvironment from '../shading/project_environment.glsl?raw';
import projections from '../shading/projections.glsl?raw';
import refract from '../shading/refract.glsl?raw';
import splitSum from '../shading/split_sum.glsl?raw';
import stretched from '../shading/stretched.glsl?raw';
import surface from '../shading/surface.glsl?raw';
import tonemap from '../shading/tonemap.glsl?raw';
import {heatShader} from '../compare/heat';
import type {Mode} from '../state';
import {fullscreen, join, ownFrame, type Program} from './program';
import {stretchedFit} from './stretched_fit';

const sharp = [generic, environment, projections, lookup];
/// What computes a surface's light, by mode.
const lighting: Record<Mode, string[]> = {
    'split-sum': [generic, diffuse, metallicRoughness, splitSum, brdf],
    stretched: [generic, diffuse, metallicRoughness, stretchedFit(), stretched, brdf],
    phong: [generic, diffuse, phongChain, phong, brdf],
    mirror: [...sharp, mirror, brdf],
    refract: [...sharp, refract, brdf],
    'monte-carlo': [ownFrame(sphericalEnvmap), sampleEnvmap, bilinear, brdf, monteCarlo],
};
/// How lights.glsl has a surface reflect lights without size.
const litBy: Record<Mode, number> = {'split-sum': 3, stretched: 3, phong: 1, mirror: 2, refract: 2, 'monte-carlo': 0};

/// The methods that can be lit by a set of probes in place of the maps of one environment.
export const probeModes = ['split-sum', 'stretched', 'phong'] as const;
type ProbeMode = (typeof probeModes)[number];
const byProbes = (mode: ProbeMode): string[] => {
    const own: Record<ProbeMode, string[]> = {'split-sum': [metallicRoughness, splitSum], stretched: [metallicRoughness, stretchedFit(), stretched], phong: [phongProbes, phong]};
    return ['#define LIGHT_BY_PROBES', probeRecords, probeVisibility, probeCells, probeBlend, probeLight, diffuse, ...own[mode], brdf];
};

/// What a model is drawn with: a method of shading, or what the page wants to know of a pixel.
export type Purpose = Mode | `${ProbeMode} by probes` | 'probe' | 'identify';

function fragments(purpose: Purpose): string[] {
    if (purpose === 'identify') return [identify];
    if (purpose === 'probe') return [material, surface, probe];
    const mode = probeModes.find(name => purpose === `${name} by probes`);
    return [material, surface, ...(mode ? byProbes(mode) : lighting[purpose as Mode]), `#define LIT_BY ${litBy[mode ?? (purpose as Mode)]}`, lights, modelFragment];
}

export const modelProgram = (purpose: Purpose): Program => ({vertexShader: join(modelVertex), fragmentShader: join(...fragments(purpose))});
export const backgroundProgram: Program = {
    vertexShader: join(backgroundVertex),
    fragmentShader: join(environment, generic, backgroundFragment),
};
export const probeBallProgram: Program = {vertexShader: join(probeBallVertex), fragmentShader: join(probeRecords, probeBallFragment)};
export const projectProgram = fullscreen(environment, projections, projectEnvironment);
export const accumulateProgram = fullscreen(accumulate);
export const levelProgram = fullscreen(environment, generic, projections, tonemap, level);
export const presentProgram = fullscreen(tonemap, heatShader(), present, presentWhite);
export const presentExtendedProgram = fullscreen(tonemap, heatShader(), present, presentExtended);
