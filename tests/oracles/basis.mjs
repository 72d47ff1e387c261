// node basis.mjs MODULES decode FILE.ktx2      the file as the reference transcoder and ktx-parse have it, as JSON; texels beside it
// node basis.mjs MODULES encode IN.hdr OUT.ktx2 LEVEL   UASTC HDR by the reference encoder; its CPU seconds as JSON
// MODULES is the node_modules folder with ktx-parse, ktx2-encoder and three.

import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, command, input, output, level] = process.argv.slice(2);
const load = file => import(pathToFileURL(path.join(modules, file)));

/// The transcoder that three.js ships: a script that defines BASIS.
async function transcoder() {
    const folder = path.join(modules, 'three/examples/jsm/libs/basis');
    const text = fs.readFileSync(path.join(folder, 'basis_transcoder.js'), 'utf8');
    const BASIS = new Function('require', '__dirname', '__filename', 'module', text + '; return BASIS;')(createRequire(import.meta.url), folder, folder, {});
    const basis = await BASIS({wasmBinary: fs.readFileSync(path.join(folder, 'basis_transcoder.wasm'))});
    basis.initializeBasis();
    return basis;
}

async function decode() {
    const bytes = new Uint8Array(fs.readFileSync(input));
    const {read} = await load('ktx-parse/dist/index.mjs');
    const container = read(bytes);
    const descriptor = container.dataFormatDescriptor[0];
    const result = {
        vkFormat: container.vkFormat, width: container.pixelWidth, height: container.pixelHeight, faces: container.faceCount,
        levels: container.levels.length, scheme: container.supercompressionScheme, model: descriptor.colorModel,
        primaries: descriptor.colorPrimaries, transfer: descriptor.transferFunction, keys: Object.keys(container.keyValue),
        failed: [],
    };
    const basis = await transcoder();
    const file = new basis.KTX2File(bytes);
    result.valid = !!file.isValid() && !!file.startTranscoding();
    const HALF = 25, BC6H = 22, halves = [];
    for (let l = 0; l < result.levels && result.valid; ++l)
        for (let f = 0; f < result.faces; ++f)
            for (const format of [HALF, BC6H]) {
                const texels = new Uint8Array(file.getImageTranscodedSizeInBytes(l, 0, f, format));
                if (!file.transcodeImage(texels, l, 0, f, format, 0, -1, -1)) result.failed.push({level: l, face: f, format});
                if (format === HALF) halves.push(Buffer.from(texels));
            }
    file.close();
    file.delete();
    fs.writeFileSync(output, Buffer.concat(halves));  // RGBA
    return result;
}

async function encode() {
    const {encodeToKTX2} = await load('ktx2-encoder/dist/node/index.js');
    const bytes = new Uint8Array(fs.readFileSync(input));
    const options = {isHDR: true, imageType: 'hdr', isUASTC: true, hdrQualityLevel: +level, generateMipmap: false, needSupercompression: false, isKTX2File: true};
    // The encoder prints to stdout; this first call is a warm-up.
    const write = process.stdout.write;
    process.stdout.write = () => true;
    const seconds = [];
    for (let k = 0; k < 3; ++k) {
        const before = process.cpuUsage();
        fs.writeFileSync(output, await encodeToKTX2(bytes, options));
        const used = process.cpuUsage(before);
        seconds.push((used.user + used.system) * 1e-6);
    }
    process.stdout.write = write;
    return {seconds: seconds.sort((a, b) => a - b)[0]};
}

console.log(JSON.stringify(await (command === 'decode' ? decode() : encode())));
process.exit(0);
