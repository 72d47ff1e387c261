// What each engine loads of a bake, and which level it should read. The tests state this independently of src/engines/.

import {repaintAtlas, repaintEnv, repaintLevels, repaintUastcHdr} from './files.mjs';

/// Roughness that reaches the shader's lookup, from the material's.
const asIs = roughness => roughness;

// three.js and Filament read level M r (2 - r).
const quadratic = (roughness, last) => last * roughness * (2 - roughness);
const linear = (roughness, last) => last * roughness;

const find = (names, end) => names.find(name => name.endsWith(end));

// What a white metal shows of filtered light, if an engine's formula is simple enough to be stated here. L(d, roughness) is the exactly filtered
// radiance, E(d) the irradiance over π.

/// Looks up a direction that is bent towards the normal by a share of roughness^4.
const leaning = (reflected, normal, roughness) => reflected.map((v, k) => v + (normal[k] - v) * roughness ** 4);

const babylon = {
    level: (roughness, last, size) => Math.max(0, 0.8 * Math.log2(size * (roughness * roughness + 0.0005))),
    // Its glTF loader turns specular antialiasing on: alpha + 3/4 of the normal's change across the pixel.
    roughness: (roughness, step) => Math.sqrt(roughness * roughness + 0.75 * step),
    // Since version 8 it mixes radiance with irradiance by alpha.
    shown: (value, {first, alpha}) => value + (first - value) * alpha,
    metal: ({L, E, normal, reflected, roughness}) => blend(1 - roughness * roughness, L(reflected, roughness), E(normal)),
    tolerance: 0.01, furnace: 0.01,
};

/// An entry is one file of one engine.
///
/// name, page         of the entry; of the module in pages/ that loads and draws
/// options            further ones of `domelight bake`
/// engine, picks      of `domelight bake --for`; the file among the bake's names that the entry is about, if the bake has it
/// files              (url of the bake's folder, names, url of its source) => the argument of the page's `load`
/// chain, repaint     the file whose levels are replaced by constants for the test of levels, and by what
/// roughness          (the material's, step) => the roughness that the shader looks up; step: the angle between the normals of neighbouring pixels
/// level              (roughness, last level, size of level 0) => the level that it reads
/// shown              (value there, {first, last, alpha, albedo}) => what it shows; first, last: the values of the outer levels
/// metal              what a white metal shows: ({L, E, normal, reflected, roughness, albedo}) => radiance
/// tolerance, furnace of the balls' means under the sky; of white in white light
/// plastics           false if the engine draws plastics differently from all others
/// theirs             a bake by the engine's own tool, in DOMELIGHT_DATA, of a picture that we bake too: both must have the same orientation and brightness
/// lights             whether its page loads the lights that `domelight lights` takes out of an environment
/// axesOnly, slow     only its directions are tested; only with --all
export const entries = [
    {
        // It filters the picture itself, on the GPU.
        name: 'three-latlong', page: 'three', engine: 'three-latlong', picks: names => find(names, '.exr'), slow: true,
        files: (url, names) => ({latlong: url + find(names, '.exr')}),
        roughness: (roughness, step) => Math.min(1, Math.max(roughness, 0.045) + step),
        metal: ({L, E, normal, reflected, roughness, albedo}) => blend(albedo, L(leaning(reflected, normal, roughness), roughness), E(normal)),
        tolerance: 0.01, furnace: 0.01,
    },
    {
        name: 'three', page: 'three', engine: 'three', picks: names => find(names, '.pmrem.ktx2'),
        files: (url, names) => ({pmrem: url + find(names, '.pmrem.ktx2')}),
        chain: names => find(names, '.pmrem.ktx2'), repaint: repaintUastcHdr,
        level: quadratic, lights: true,
        // It increases the roughness by the change of the normal across the pixel, which prevents sparkling.
        roughness: (roughness, step) => Math.min(1, Math.max(roughness, 0.045) + step),
        // The energy that single scattering loses is added as diffuse light, taken from the last level.
        shown: (value, {last, albedo}) => albedo * value + (1 - albedo) * last,
        metal: ({L, E, normal, reflected, roughness, albedo}) => blend(albedo, L(leaning(reflected, normal, roughness), roughness), E(normal)),
        tolerance: 0.01, furnace: 0.01,
    },
    {
        name: 'filament', page: 'filament', engine: 'filament', picks: names => find(names, '_ibl.ktx'),
        files: (url, names) => ({ibl: url + find(names, '_ibl.ktx'), skybox: url + find(names, '_skybox.ktx')}),
        chain: names => find(names, '_ibl.ktx'), repaint: repaintLevels,
        level: quadratic,
        // Its least roughness on mobile graphics, and its widening where the normal turns (specular antialiasing, variance 0.15).
        roughness: (roughness, step) => (Math.max(roughness, 0.089) ** 4 + 2 * 0.15 * 2 * step * step) ** 0.25,
        metal: ({L, normal, reflected, roughness}) => L(leaning(reflected, normal, roughness), roughness),
        tolerance: 0.01, furnace: 0.01,
        theirs: {by: 'cmgen', latlong: 'usd', files: url => ({ibl: `${url}symmetrical_garden_ibl.ktx`, skybox: `${url}symmetrical_garden_skybox.ktx`}),
                 brightness: 0.01},
    },
    {
        name: 'babylon', page: 'babylon', engine: 'babylon', options: ['--format', 'dds'], picks: names => find(names, '.dds'),
        files: (url, names) => ({prefiltered: url + find(names, '.dds')}),
        chain: names => find(names, '.dds'), repaint: repaintLevels,
        ...babylon,
        theirs: {by: 'its own tool', latlong: 'usd', files: url => ({prefiltered: `${url}symmetrical_garden.env`}), brightness: 0.01},
    },
    {
        name: 'babylon-env', page: 'babylon', engine: 'babylon', picks: names => find(names, '.env'),
        files: (url, names) => ({prefiltered: url + find(names, '.env')}),
        chain: names => find(names, '.env'), repaint: repaintEnv,
        ...babylon,
        // The irradiance is the polynomial of the file, which is not replaced: it remains that of the furnace.
        shown: (value, {alpha}) => value + (1 - value) * alpha,
        // Its own tool cuts light at 4096 before it makes the polynomial, which Babylon mixes in: ours has the whole sun.
        theirs: {by: 'its own tool', latlong: 'usd', files: url => ({prefiltered: `${url}symmetrical_garden.env`}), brightness: 0.05},
    },
    {
        // The same file in Babylon's right-handed world.
        name: 'babylon-right-handed', page: 'babylon', engine: 'babylon', picks: names => find(names, '.env'), axesOnly: true,
        files: (url, names) => ({prefiltered: url + find(names, '.env'), rightHanded: true}),
    },
    {
        name: 'playcanvas', page: 'playcanvas', engine: 'playcanvas', picks: names => find(names, '.png'),
        files: (url, names) => ({atlas: url + find(names, '.png')}),
        chain: names => find(names, '.png'), repaint: repaintAtlas,
        level: roughness => 5 * roughness, roughness: asIs,
        metal: ({L, reflected, roughness}) => L(reflected, roughness),
        plastics: false,  // it adds F0 at every angle and roughness
        tolerance: 0.02, furnace: 0.01,
    },
    {
        name: 'khronos', page: 'khronos', engine: 'khronos', picks: names => find(names, 'specular.ktx2'),
        files: (url, names, environment) => ({panorama: environment, specular: url + 'ggx/specular.ktx2', sheen: url + 'charlie/sheen.ktx2',
                                              diffuse: url + 'lambertian/diffuse.ktx2', brdf: url + 'brdf.ktx2', levels: 5}),
        chain: () => 'ggx/specular.ktx2', repaint: repaintLevels,
        level: linear, roughness: asIs,
        metal: ({L, reflected, roughness}) => L(reflected, roughness),
        tolerance: 0.01, furnace: 0.01,
    },
    {
        // What the viewer makes of the lat-long picture by itself, to which the baked cubes must be turned alike.
        name: 'khronos-panorama', page: 'khronos', engine: 'khronos', picks: names => find(names, 'specular.ktx2'), axesOnly: true, slow: true,
        files: (url, names, environment) => ({panorama: environment}),
    },
];

function blend(part, a, b) {
    return a.map((v, k) => part * v + (1 - part) * b[k]);
}
