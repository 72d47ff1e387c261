// The Khronos glTF viewer, drawn to the canvas without tone mapping, in bytes of gamma 2.2 (its approximation to sRGB).
import {GltfView, GltfState} from '@khronosgroup/gltf-viewer';
import {canvasPixels, script} from './pixels.mjs';

await script('/npm/@khronosgroup/gltf-viewer/dist/libs/libktx.js');

export const version = (await (await fetch('/npm/@khronosgroup/gltf-viewer/package.json')).json()).version;
const canvas = document.getElementById('canvas');
const gl = canvas.getContext('webgl2', {alpha: true, antialias: false, preserveDrawingBuffer: true});
const view = new GltfView(gl);
const state = view.createState();
const loader = view.createResourceLoader(() => {}, undefined, '/npm/@khronosgroup/gltf-viewer/dist/libs/');
state.renderingParameters.toneMap = GltfState.ToneMaps.NONE;
state.renderingParameters.renderEnvironmentMap = false;
state.renderingParameters.clearColor = [0, 0, 0, 0];
state.renderingParameters.usePunctual = false;
state.renderingParameters.internalMSAA = 1;

// loadEnvironment filters on the GPU, which takes minutes in software. `wanted(n)` says which of its draws are done.
async function loadPanorama(url, wanted) {
    const drawArrays = gl.drawArrays;
    let count = 0;
    gl.drawArrays = function (...rest) { if (wanted(count++)) drawArrays.apply(gl, rest); };
    state.environment = await loader.loadEnvironment(url, {lut_sheen_E_file: '/files/white.png'});
    gl.drawArrays = drawArrays;
}

export async function load({panorama, specular, sheen, diffuse, brdf, levels}) {
    state.renderingParameters.environmentRotation = 0;
    if (!specular) return loadPanorama(panorama, n => n < 6 || (n >= 12 && n < 18));  // the cube, and level 0 of its GGX filter
    await loadPanorama(panorama, () => false);
    // docs/engines/khronos.md
    const environment = state.environment;
    const use = async (map, url, target, filter) => {
        const texture = environment.textures[map.index].glTexture = await view.ktxDecoder.loadKtxFromUri(url);
        gl.bindTexture(target, texture);
        gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, filter);
        gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
        gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    };
    await use(environment.specularEnvMap, specular, gl.TEXTURE_CUBE_MAP, gl.LINEAR_MIPMAP_LINEAR);
    await use(environment.sheenEnvMap, sheen, gl.TEXTURE_CUBE_MAP, gl.LINEAR_MIPMAP_LINEAR);
    await use(environment.diffuseEnvMap, diffuse, gl.TEXTURE_CUBE_MAP, gl.LINEAR);
    await use(environment.lut, brdf, gl.TEXTURE_2D, gl.LINEAR);
    await use(environment.sheenLUT, brdf, gl.TEXTURE_2D, gl.LINEAR);
    environment.mipCount = levels;
    environment.iblIntensityScale = 1;
    // end
}

// The matrix for the viewer, by columns: right, up, backward, position.
function cameraToWorld(eye, target) {
    const unit = a => a.map(x => x / Math.hypot(...a));
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const back = unit(eye.map((x, k) => x - target[k])), right = unit(cross([0, 1, 0], back)), up = cross(back, right);
    return new Float32Array([...right, 0, ...up, 0, ...back, 0, ...eye, 1]);
}

export async function draw({model, eye, target, fovDeg, width, height}) {
    canvas.width = width;
    canvas.height = height;
    state.gltf = await loader.loadGltf(model);
    state.sceneIndex = 0;
    state.cameraIndex = undefined;
    const camera = state.userCamera;
    camera.aspectRatio = width / height;
    camera.perspective.yfov = fovDeg * Math.PI / 180;
    camera.perspective.znear = 0.1;
    camera.perspective.zfar = 100;
    camera.transform = cameraToWorld(eye, target);
    view.renderFrame(state, width, height);
    return canvasPixels(gl, 2.2);
}
