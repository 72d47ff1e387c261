// Babylon.js: PBRMaterial from its own glTF loader, drawn into a float target.
import {packed, script} from './pixels.mjs';

await script('/npm/babylonjs/babylon.js');
await script('/npm/babylonjs-loaders/babylonjs.loaders.min.js');

export const version = BABYLON.Engine.Version;
const engine = new BABYLON.Engine(document.getElementById('canvas'), false, {preserveDrawingBuffer: true});
let url, rightHanded, baked, probes;

/// what: {prefiltered: a file, rightHanded}, {probes: the list of a set of probes, rightHanded}, or instead of the file {source, options} of the npm package's adapter, and whether a texture of Babylon is
/// given to that in place of the source (again).
export async function load(what) {
    url = what.prefiltered;
    rightHanded = what.rightHanded === true;
    baked = what.source && what;
    probes = what.probes;
}

async function bakedTexture(scene) {
    const {bakeEnvironment} = await import('/npm/domelight/babylon.js');
    const texture = await bakeEnvironment(scene, baked.source, baked.options);
    return baked.again ? bakeEnvironment(scene, texture, baked.options) : texture;
}

// The light of the nearest probe for each mesh of the scene.
async function reflect(scene, url) {
    // docs/engines/babylon.md, local probes
    const {probes} = await (await fetch(url)).json();
    const place = ([x, y, z]) => new BABYLON.Vector3(scene.useRightHandedSystem ? x : -x, y, z);
    const maps = probes.map(({files, position, box}) => {
        const map = BABYLON.CubeTexture.CreateFromPrefilteredData(new URL(files[0], new URL(url, location)).href, scene);
        if (scene.useRightHandedSystem) map.rotationY = Math.PI;
        map.boundingBoxPosition = place(position);
        if (box) map.boundingBoxSize = BABYLON.Vector3.FromArray(box.high.map((high, k) => high - box.low[k]));
        return map;
    });
    for (const mesh of scene.meshes.filter(mesh => mesh.material)) {
        const centre = mesh.getBoundingInfo().boundingBox.centerWorld, far = map => map.boundingBoxPosition.subtract(centre).length();
        mesh.material.reflectionTexture = maps.reduce((a, b) => (far(b) < far(a) ? b : a));
    }
    // end
}

async function light(scene) {
    if (baked) return void (scene.environmentTexture = await bakedTexture(scene));
    // docs/engines/babylon.md
    const environment = BABYLON.CubeTexture.CreateFromPrefilteredData(url, scene);
    if (scene.useRightHandedSystem) environment.rotationY = Math.PI;
    scene.environmentTexture = environment;
    // end
}

export async function draw({model, eye, target, fovDeg, width, height}) {
    const scene = new BABYLON.Scene(engine);
    scene.useRightHandedSystem = rightHanded;
    scene.clearColor = new BABYLON.Color4(0, 0, 0, 0);
    scene.imageProcessingConfiguration.applyByPostProcess = true;  // the material writes linear light
    if (!probes) await light(scene);
    await BABYLON.SceneLoader.AppendAsync('', model, scene);
    if (probes) await reflect(scene, probes);
    // In its left-handed world the loader turns a model so that +X of the file is -X.
    const place = ([x, y, z]) => new BABYLON.Vector3(rightHanded ? x : -x, y, z);
    const camera = new BABYLON.FreeCamera('camera', place(eye), scene);
    camera.setTarget(place(target));
    camera.fov = fovDeg * Math.PI / 180;
    camera.minZ = 0.1;
    const floats = new BABYLON.RenderTargetTexture('floats', {width, height}, scene, {type: BABYLON.Constants.TEXTURETYPE_FLOAT, generateMipMaps: false});
    camera.outputRenderTarget = floats;
    await scene.whenReadyAsync(true);
    scene.render();
    const rgba = await floats.readPixels();
    scene.dispose();
    return packed(rgba, width, height);
}
