// What three.js' own PMREMGenerator makes of photographs, in headless Chromium without a GPU: its levels as DDS cubes of half floats, for bench/read_floor.cpp.
//
//   node bench/three_pmrem.mjs MODULES FOLDER PHOTOGRAPH.hdr...
//
// MODULES: the node_modules with three and playwright-core (build/engines/node_modules, which `./test --engines` makes). FOLDER gets a PHOTOGRAPH.dds each.

import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import {launch, serve} from '../tests/engines/browser/browser.mjs';
import {readHdr} from '../tests/engines/browser/files.mjs';

const [modules, folder, ...photographs] = process.argv.slice(2);
if (!photographs.length) throw new Error('Which photographs? node bench/three_pmrem.mjs MODULES FOLDER PHOTOGRAPH.hdr...');

const work = fs.mkdtempSync('/tmp/three-pmrem-');
fs.writeFileSync(path.join(work, 'page.html'), '<script type="importmap">{"imports": {"three": "/npm/three/build/three.module.js"}}</script>');
fs.mkdirSync(folder, {recursive: true});

/// In the page: the levels of the filtered cube, each its faces' rows of RGBA half floats, in base64.
async function filter({url, width, height}) {
    const THREE = await import('three');
    const pixels = new Float32Array(await (await fetch(url)).arrayBuffer());
    const texture = new THREE.DataTexture(pixels, width, height, THREE.RGBAFormat, THREE.FloatType);
    Object.assign(texture, {mapping: THREE.EquirectangularReflectionMapping, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, flipY: true, needsUpdate: true});
    const renderer = new THREE.WebGLRenderer(), generator = new THREE.PMREMGenerator(renderer), target = generator.fromEquirectangular(texture);
    const gl = renderer.getContext();
    return target.texture.mipmaps.map(({width: size}, level) => {
        const halves = new Uint16Array(6 * 4 * size * size);
        for (let face = 0; face < 6; ++face) {
            renderer.setRenderTarget(target, face, level);
            gl.readPixels(0, 0, size, size, gl.RGBA, gl.HALF_FLOAT, halves.subarray(4 * size * size * face, 4 * size * size * (face + 1)));
        }
        if (gl.getError()) throw new Error(`level ${level} cannot be read back`);
        const bytes = new Uint8Array(halves.buffer);
        let text = '';
        for (let k = 0; k < bytes.length; k += 32768) text += String.fromCharCode(...bytes.subarray(k, k + 32768));
        return btoa(text);
    });
}

/// A DDS cube of RGBA half floats with all levels of a face one after the other.
function dds(levels) {
    const size = Math.round(Math.sqrt(levels[0].length / 48)), header = Buffer.alloc(148);
    header.write('DDS ');
    const words = {4: 124, 8: 0x2100f, 12: size, 16: size, 20: 8 * size, 28: levels.length, 76: 32, 80: 4, 108: 0x401008, 112: 0xfe00, 128: 10, 132: 3, 136: 4, 140: 1};
    for (const [at, value] of Object.entries(words)) header.writeUInt32LE(value, Number(at));
    header.write('DX10', 84);
    const parts = [header];
    for (let face = 0; face < 6; ++face) for (const level of levels) parts.push(level.subarray((level.length / 6) * face, (level.length / 6) * (face + 1)));
    return Buffer.concat(parts);
}

const browser = await launch(path.resolve(modules), execFileSync('sh', ['-c', 'command -v chromium'], {encoding: 'utf8'}).trim());
const server = await serve({'/npm/': path.resolve(modules), '/work/': work});
const page = await browser.newPage();
page.on('pageerror', error => console.error(`page: ${error}`));
await page.goto(`${server.url}/work/page.html`);
for (const file of photographs) {
    const {rgb, width, height} = readHdr(file), rgba = new Float32Array(4 * width * height).fill(1);
    for (let k = 0; k < width * height; ++k) rgba.set(rgb.subarray(3 * k, 3 * k + 3), 4 * k);
    fs.writeFileSync(path.join(work, 'light.f32'), Buffer.from(rgba.buffer));
    const levels = (await page.evaluate(filter, {url: '/work/light.f32', width, height})).map(text => Buffer.from(text, 'base64'));
    const to = path.join(folder, `${path.basename(file, '.hdr')}.dds`);
    fs.writeFileSync(to, dds(levels));
    console.log(`${to}: ${levels.length} levels`);
}
await browser.close();
server.close();
fs.rmSync(work, {recursive: true});
