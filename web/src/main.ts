// Starts the app.

import {Baker} from './bake/baker';
import {Stage} from './render/stage';
import {builtInModels, type Model} from './scene/built_in';
import {viewOf} from './scene/framing';
import {loadModel} from './scene/load_model';
import {studio} from './scene/studio';
import {Store} from './state';

const canvas = document.createElement('canvas');
document.body.append(canvas);
const store = new Store(location.hash);
const {state} = store;
const stage = new Stage(canvas);
const baker = new Baker();

function showModel(model: Model) {
    const view = viewOf(model, innerWidth / innerHeight);
    store.set({eye: view.eye, target: view.target, fov: view.fovDeg});
    stage.setModel(model.root);
}
async function bakeIt() {
    stage.setBake(await baker.bake(state.size));
}
const resize = () => stage.resize(innerWidth, innerHeight);
resize();
addEventListener('resize', resize);
showModel(builtInModels[state.model]!());
const brdf = baker.brdf(64).then(table => stage.setBrdf(table));
stage.setEnvironment(await baker.use('studio', studio()));
await bakeIt();
await brdf;
addEventListener('dragover', event => event.preventDefault());
async function openFiles(files: Iterable<File>) {
    for (const file of files) {
        const bytes = await file.arrayBuffer();
        if (/\.(glb|gltf)$/i.test(file.name)) showModel(await loadModel(file.name, bytes));
        else {
            stage.setEnvironment(await baker.open(file.name, bytes));
            await bakeIt();
        }
    }
}
addEventListener('drop', event => {
    event.preventDefault();
    void openFiles(event.dataTransfer?.files ?? []);
});

/// For tests: the mean of a pane's frames as RGB floats, rows from the top, in base64.
function readPane(index: number): string {
    const {target} = stage.panes[index]!, {width, height} = target, rgba = new Float32Array(4 * width * height);
    stage.renderer.readRenderTargetPixels(target, 0, 0, width, height, rgba);
    const rgb = new Float32Array(3 * width * height);
    for (let y = 0, to = 0; y < height; ++y)
        for (let x = 0; x < width; ++x, to += 3) rgb.set(rgba.subarray(4 * ((height - 1 - y) * width + x), 4 * ((height - 1 - y) * width + x) + 3), to);
    const bytes = new Uint8Array(rgb.buffer), parts = [];
    for (let k = 0; k < bytes.length; k += 0x8000) parts.push(String.fromCharCode(...bytes.subarray(k, k + 0x8000)));
    return btoa(parts.join(''));
}
Object.assign(window, {domelight: {ready: true, openFiles, readPane, stage, store}});

function frame() {
    stage.apply(state);
    if (stage.panes[0].count < 64) stage.advance(stage.panes[0], state.mode);
    stage.show(state);
    requestAnimationFrame(frame);
}
frame();
