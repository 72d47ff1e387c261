// three.js: WebGLRenderer, MeshPhysicalMaterial from its own glTF loader, drawn into a float target.
import * as THREE from 'three';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {KTX2Loader} from 'three/addons/loaders/KTX2Loader.js';
import {LightProbeGridWebGL} from 'three/addons/lighting/LightProbeGridWebGL.js';
import {packed} from './pixels.mjs';

export const version = THREE.REVISION;
const renderer = new THREE.WebGLRenderer({canvas: document.getElementById('canvas')});
const scene = new THREE.Scene();

export const load = ({pmrem, latlong}) => (pmrem ? loadPmrem(pmrem) : loadLatlong(latlong));

// The prefiltered cube.
const basis = '/npm/three/examples/jsm/libs/basis/';
let loader;
async function loadPmrem(url) {
    loader?.dispose();
    // docs/engines/three.md, the prefiltered cube
    loader = new KTX2Loader().setTranscoderPath(basis).detectSupport(renderer);
    const texture = await loader.loadAsync(url);
    texture.isPMREMTexture = true;
    scene.environment = texture;
    // end
}

// The lat-long picture, which three.js filters itself.
async function loadLatlong(url) {
    // docs/engines/three.md, the lat-long picture
    const texture = await new EXRLoader().loadAsync(url);
    texture.mapping = THREE.EquirectangularReflectionMapping;
    scene.environment = texture;
    // end
}

// A grid of probes in place of the environment.
export async function loadProbes(url) {
    scene.environment = null;
    // docs/engines/three.md, a grid of probes
    const {position, size, resolution, texture} = await (await fetch(url)).json();
    const grid = new LightProbeGridWebGL(...size, ...resolution);
    grid.position.fromArray(position);
    grid.updateBoundingBox();
    grid.texture = await new KTX2Loader().detectSupport(renderer).loadAsync(new URL(texture, new URL(url, location)).href);
    grid.texture.minFilter = grid.texture.magFilter = THREE.LinearFilter;
    scene.add(grid);
    // end
}

// Lights beside the environment that they were taken out of. Resolves to their names, colours and intensities as three.js has them.
export async function loadLights(url) {
    // docs/engines/three.md, the lights
    const lights = (await new GLTFLoader().loadAsync(url)).scene;
    scene.add(lights);
    // end
    const found = [];
    lights.traverse(light => light.isDirectionalLight && found.push({color: light.color.toArray(), intensity: light.intensity}));
    return found;
}

const models = new Map();

export async function draw({model, eye, target, fovDeg, width, height}) {
    if (!models.has(model)) models.set(model, (await new GLTFLoader().loadAsync(model)).scene);
    scene.add(models.get(model));
    const camera = new THREE.PerspectiveCamera(fovDeg, width / height, 0.1, 100);
    camera.position.set(...eye);
    camera.lookAt(...target);

    const floats = new THREE.WebGLRenderTarget(width, height, {type: THREE.FloatType});
    renderer.setRenderTarget(floats);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const rgba = new Float32Array(4 * width * height);
    renderer.readRenderTargetPixels(floats, 0, 0, width, height, rgba);
    floats.dispose();
    scene.remove(models.get(model));
    return packed(rgba, width, height);
}
