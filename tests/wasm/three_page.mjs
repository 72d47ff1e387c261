// Runs in the browser: what three.js reads of its own PMREM and of ours, by its own lookup, in given directions and at given roughnesses.
import * as THREE from 'three';
import {configure} from 'domelight';
import {bakeEnvironment} from 'domelight/three';

configure({module: '/npm/domelight/domelight.wasm'});
const renderer = new THREE.WebGLRenderer();

const fetchFloats = async url => new Float32Array(await (await fetch(url)).arrayBuffer());

/// A lat-long texture as HDRLoader makes it: RGBA floats, the first row at the top.
function textureOf(rgb, width, height) {
    const data = new Float32Array(4 * width * height).fill(1);
    for (let k = 0; k < width * height; ++k) data.set(rgb.subarray(3 * k, 3 * k + 3), 4 * k);
    const texture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, THREE.FloatType);
    Object.assign(texture, {mapping: THREE.EquirectangularReflectionMapping, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, flipY: true, needsUpdate: true});
    return texture;
}

/// Half of the width and height, by averages of four that keep the power: rows count by their solid angle.
function halved(rgb, width, height) {
    const result = new Float32Array(rgb.length / 4), w = width / 2;
    const band = y => Math.cos((y * Math.PI) / height) - Math.cos(((y + 1) * Math.PI) / height);
    for (let y = 0; y < height / 2; ++y) {
        const upper = band(2 * y) / (band(2 * y) + band(2 * y + 1)) / 2, lower = 0.5 - upper;
        for (let x = 0; x < w; ++x)
            for (let c = 0; c < 3; ++c) {
                const at = (j, i) => rgb[3 * ((2 * y + j) * width + 2 * x + i) + c];
                result[3 * (y * w + x) + c] = upper * (at(0, 0) + at(0, 1)) + lower * (at(1, 0) + at(1, 1));
            }
    }
    return result;
}

const lookup = new THREE.ShaderMaterial({
    uniforms: {cube: {value: null}, directions: {value: null}, mirror: {value: 1}, level: {value: 0}},
    vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `precision highp float; precision highp samplerCube;
        uniform samplerCube cube; uniform sampler2D directions; uniform float mirror, level;
        void main() {
            vec3 d = texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz;
            gl_FragColor = textureLod(cube, vec3(mirror * d.x, d.yz), level);
        }`,
});

/// Radiance that the texture shows in each direction at each level: arrays of RGBA.
function readAt(texture, uploaded, directions, levels) {
    const count = directions.length / 3, scene = new THREE.Scene(), camera = new THREE.OrthographicCamera();
    const rgba = new Float32Array(4 * count);
    for (let k = 0; k < count; ++k) rgba.set(directions.subarray(3 * k, 3 * k + 3), 4 * k);
    const positions = new THREE.DataTexture(rgba, count, 1, THREE.RGBAFormat, THREE.FloatType);
    positions.needsUpdate = true;
    scene.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), lookup));
    scene.children[0].frustumCulled = false;
    const target = new THREE.WebGLRenderTarget(count, 1, {type: THREE.FloatType});
    // WebGLCubes that three.js has drawn are looked up at (x, y, z), uploaded ones at (-x, y, z).
    Object.assign(lookup.uniforms.cube, {value: texture});
    lookup.uniforms.directions.value = positions;
    lookup.uniforms.mirror.value = uploaded ? -1 : 1;
    const found = levels.map(level => {
        lookup.uniforms.level.value = level;
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        const pixels = new Float32Array(4 * count);
        renderer.readRenderTargetPixels(target, 0, 0, count, 1, pixels);
        return Array.from(pixels);
    });
    renderer.setRenderTarget(null);
    return found;
}

/// Both filters of one photograph, at full and half resolution, read at `roughnesses`.
export async function compare({url, width, height, directions, roughnesses, options}) {
    const rgb = await fetchFloats(url), d = Float32Array.from(directions);
    const sources = [[rgb, width, height], [halved(rgb, width, height), width / 2, height / 2]];
    const result = {theirs: [], ours: [], times: {}};
    for (const [pixels, w, h] of sources) {
        const texture = textureOf(pixels, w, h);
        const generator = new THREE.PMREMGenerator(renderer);
        const target = generator.fromEquirectangular(texture);
        const levelsOf = last => roughnesses.map(r => last * r * (2 - r));
        result.theirs.push(readAt(target.texture, false, d, levelsOf(target.texture.mipmaps.length - 1)));
        const start = performance.now();
        const ours = await bakeEnvironment(renderer, texture, options);
        result.times[w] = performance.now() - start;
        result.ours.push(readAt(ours, true, d, levelsOf(ours.image[0].mipmaps.length - 1)));
        generator.dispose();
    }
    return result;
}

/// A cube that the scene was drawn into, read back and baked: the mean of its levels, for a constant background.
export async function probe() {
    const scene = new THREE.Scene(), target = new THREE.WebGLCubeRenderTarget(64, {type: THREE.HalfFloatType});
    scene.background = new THREE.Color(0.5, 0.25, 1);
    scene.background.setRGB(0.5, 0.25, 1, THREE.LinearSRGBColorSpace);
    const red = new THREE.Mesh(new THREE.PlaneGeometry(40, 40), new THREE.MeshBasicMaterial({color: new THREE.Color(4, 0, 0), side: THREE.DoubleSide}));
    red.position.set(10, 0, 0);
    red.lookAt(0, 0, 0);
    scene.add(red);
    new THREE.CubeCamera(0.1, 100, target).update(renderer, scene);
    const texture = await bakeEnvironment(renderer, target, {size: 64});
    return readAt(texture, true, Float32Array.from([1, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, -1]), [0, 3]);
}

/// A cube of pictures in memory, whose faces have one colour each, as its own PMREM and ours show it along the axes and at a corner; and an equirectangular
/// render target into which three.js has copied a picture.
export async function cubes() {
    const colours = [[4, 0, 0], [0, 4, 0], [0, 0, 4], [1, 1, 0], [0, 1, 1], [1, 0, 1]], size = 32, axes = Float32Array.from([1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1]);
    const faces = colours.map(([r, g, b]) => {
        const data = Float32Array.from({length: 4 * size * size}, (_, k) => [r, g, b, 1][k % 4]);
        return new THREE.DataTexture(data, size, size, THREE.RGBAFormat, THREE.FloatType);
    });
    const cube = new THREE.CubeTexture(faces);
    Object.assign(cube, {type: THREE.FloatType, format: THREE.RGBAFormat, colorSpace: THREE.LinearSRGBColorSpace, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, generateMipmaps: false, needsUpdate: true});
    faces.forEach(face => { face.needsUpdate = true; });
    const theirs = new THREE.PMREMGenerator(renderer).fromCubemap(cube).texture;

    const width = 64, height = 32, rgb = Float32Array.from({length: 3 * width * height}, (_, k) => 1 + (k % 3) + Math.floor(k / 3 / width) / height);
    const picture = textureOf(rgb, width, height), target = new THREE.WebGLRenderTarget(width, height, {type: THREE.FloatType}), scene = new THREE.Scene();
    const copying = new THREE.ShaderMaterial({uniforms: {picture: {value: picture}}, vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
                                              fragmentShader: 'uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at); }'});
    scene.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), copying));
    scene.children[0].frustumCulled = false;
    renderer.setRenderTarget(target);
    renderer.render(scene, new THREE.OrthographicCamera());
    renderer.setRenderTarget(null);
    const bake = async source => readAt(await bakeEnvironment(renderer, source, {size: 64}), true, axes, [0, 3]);
    return {colours, theirs: readAt(theirs, false, axes, [0]), ours: await bake(cube), picture: await bake(picture), target: await bake(target)};
}
