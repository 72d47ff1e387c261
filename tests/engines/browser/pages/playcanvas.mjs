// PlayCanvas: StandardMaterial from its own glTF loader, drawn into a float target.
import * as pc from 'playcanvas';
import {packed} from './pixels.mjs';

export const version = pc.version;
const canvas = document.getElementById('canvas');
const device = await pc.createGraphicsDevice(canvas, {deviceTypes: [pc.DEVICETYPE_WEBGL2], antialias: false});
const options = new pc.AppOptions();
options.graphicsDevice = device;
options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem];
options.resourceHandlers = [pc.TextureHandler, pc.ContainerHandler];
const app = new pc.AppBase(canvas);
app.init(options);
app.autoRender = false;
app.start();

const loaded = asset => new Promise((resolve, reject) => {
    asset.ready(resolve);
    asset.on('error', reject);
    app.assets.add(asset);
    app.assets.load(asset);
});

/// Of a file that is an atlas, or of a source by the npm package's adapter, which is given the file, or (`loads`) the
/// texture that PlayCanvas loads of it: true, or turned into a cube ("cube"), or that cube as a render target ("target").
export async function load({atlas: url, source, loads, options}) {
    if (source) return bake(source, loads, options);
    // docs/engines/playcanvas.md
    const atlas = new pc.Asset('light', 'texture', {url}, {type: pc.TEXTURETYPE_RGBP, mipmaps: false});
    await loaded(atlas);
    atlas.resource.addressU = atlas.resource.addressV = pc.ADDRESS_CLAMP_TO_EDGE;
    app.scene.envAtlas = atlas.resource;
    // end
}

const pictures = new Map();
async function bake(source, loads, options) {
    const {bakeEnvironment} = await import('/npm/domelight/playcanvas.js');
    if (loads) {
        // A second asset of the same file would share its texture, and make it one of RGBA bytes.
        if (!pictures.has(source)) pictures.set(source, new pc.Asset('picture', 'texture', {url: source}));
        const asset = pictures.get(source);
        if (!asset.loaded) await loaded(asset);
        source = asset.resource;
        if (loads === 'cube') source = pc.EnvLighting.generateLightingSource(source, {size: 256});
        if (loads === 'target') source = new pc.RenderTarget({colorBuffer: pc.EnvLighting.generateLightingSource(source, {size: 256}), depth: false});
    }
    app.scene.envAtlas = await bakeEnvironment(app.scene, source, {pc, ...options});
}

const models = new Map();

export async function draw({model, eye, target, fovDeg, width, height}) {
    if (!models.has(model)) {
        const asset = new pc.Asset(model, 'container', {url: model});
        await loaded(asset);
        models.set(model, asset.resource.instantiateRenderEntity());
    }
    const entity = models.get(model);
    app.root.addChild(entity);
    const texture = new pc.Texture(device, {width, height, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false, minFilter: pc.FILTER_NEAREST,
                                            magFilter: pc.FILTER_NEAREST});
    const floats = new pc.RenderTarget({colorBuffer: texture, depth: true});
    const camera = new pc.Entity('camera');
    camera.addComponent('camera', {fov: fovDeg, nearClip: 0.1, farClip: 100, clearColor: new pc.Color(0, 0, 0, 0), renderTarget: floats,
                                   aspectRatioMode: pc.ASPECT_MANUAL, aspectRatio: width / height, gammaCorrection: pc.GAMMA_NONE,
                                   toneMapping: pc.TONEMAP_NONE,
                                   layers: app.scene.layers.layerList.map(l => l.id).filter(id => id !== pc.LAYERID_SKYBOX)});
    camera.setPosition(...eye);
    camera.lookAt(...target);
    app.root.addChild(camera);
    app.render();
    const rgba = await texture.read(0, 0, width, height, {renderTarget: floats, immediate: true});
    camera.destroy();
    app.root.removeChild(entity);
    floats.destroy();
    texture.destroy();
    return packed(rgba, width, height);
}
