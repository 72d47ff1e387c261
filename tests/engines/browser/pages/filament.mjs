// Filament's own web build: the ubershader of its glTF loader, drawn to the canvas in linear light.
import {canvasPixels, script} from './pixels.mjs';

await script('/npm/filament/filament.js');
await new Promise(resolve => Filament.init([], resolve));

export const version = (await (await fetch('/npm/filament/package.json')).json()).version;
const canvas = document.getElementById('canvas');
const engine = Filament.Engine.create(canvas, {alpha: true, antialias: false, preserveDrawingBuffer: true});
const gl = canvas.getContext('webgl2');
const scene = engine.createScene();
const renderer = engine.createRenderer();
const swapChain = engine.createSwapChain();
const view = engine.createView();
const camera = engine.createCamera(Filament.EntityManager.get().create());
view.setScene(scene);
view.setCamera(camera);
view.setPostProcessingEnabled(false);  // no tone mapping, no gamma: the canvas gets linear light
renderer.setClearOptions({clearColor: [0, 0, 0, 0], clear: true});

const bytes = async url => new Uint8Array(await (await fetch(url)).arrayBuffer());

export async function load({ibl, skybox}) {
    const intensity = 1;
    // docs/engines/filament.md
    const light = engine.createIblFromKtx1(await bytes(ibl));
    light.setIntensity(intensity);
    scene.setIndirectLight(light);
    scene.setSkybox(engine.createSkyFromKtx1(await bytes(skybox)));
    // end
    scene.setSkybox(null);  // only the balls are measured
}

const models = new Map();

export async function draw({model, eye, target, fovDeg, width, height}) {
    if (!models.has(model)) {
        const loader = engine.createAssetLoader();
        const asset = loader.createAsset(await bytes(model));
        await new Promise(resolve => asset.loadResources(resolve, null, location.href, 1));
        models.set(model, asset);
    }
    const entities = models.get(model).getEntities();
    scene.addEntities(entities);
    canvas.width = width;
    canvas.height = height;
    view.setViewport([0, 0, width, height]);
    camera.setProjectionFov(fovDeg, width / height, 0.1, 100, Filament.Camera$Fov.VERTICAL);
    camera.lookAt(eye, target, [0, 1, 0]);
    camera.setExposureDirect(1);
    let pixels;
    for (let frame = 0; frame < 3; ++frame) {  // shaders compile while the first ones are drawn
        await new Promise(requestAnimationFrame);
        renderer.render(swapChain, view);
        engine.execute();
        pixels = canvasPixels(gl, 1);
    }
    scene.removeEntities(entities);
    return pixels;
}
