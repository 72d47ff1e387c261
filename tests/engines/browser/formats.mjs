// Files read by programs other than Domelight: ktx-parse, parse-dds, OpenEXR's exrheader, the GPU's BC6H, Basis Universal.

import fs from 'node:fs';
import path from 'node:path';
import {createRequire} from 'node:module';
import {execFileSync} from 'node:child_process';
import {call, open} from './browser.mjs';
import {replaceLevels} from './files.mjs';

const floats = base64 => {
    const bytes = Buffer.from(base64, 'base64');
    return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

/// Relative RMS difference of two cubes in RGBA, by solid angle, as the manifest has it.
function relativeError(a, b) {
    const size = Math.sqrt(b.length / 24), at = k => (2 * k + 1) / size - 1;
    let error = 0, norm = 0;
    for (let k = 0; k < b.length / 4; ++k) {
        const weight = (1 + at(k % size) ** 2 + at(Math.floor(k / size) % size) ** 2) ** -1.5;
        for (let c = 4 * k; c < 4 * k + 3; ++c) {
            error += weight * (a[c] - b[c]) ** 2;
            norm += weight * b[c] ** 2;
        }
    }
    return Math.sqrt(error / norm);
}

/// VkFormat of each encoding of the bake.
const vkFormats = {rgba16f: 97, rgba32f: 109, rgb9e5: 123, r11g11b10f: 122, bc6h: 143, 'uastc-hdr': 1000066000, 'astc4x4-hdr': 1000066000,
                   'astc6x6-hdr': 1000066004,
                   rgbm: 37, rgbd: 37, rgbp: 37};

/// `tools`: {claim, skip, domelight, work, modules, browser, server, log, help}.
export async function testFormats({claim, skip, domelight, work, modules, browser, server, log, encodings}) {
    const {read} = await import(path.join(modules, 'ktx-parse/dist/index.mjs'));
    const parseDds = createRequire(path.join(modules, 'x.js'))('parse-dds');
    const source = path.join(work, 'axes.hdr'), manifest = folder => JSON.parse(fs.readFileSync(path.join(folder, 'manifest.json')));
    const bake = (name, ...args) => {
        const folder = path.join(work, `format-${name}`);
        domelight('bake', source, '-o', folder, '--size', 64, '--levels', 4, '--brdf-form', 'none', '--quiet', '--no-preview', ...args);
        return folder;
    };
    const plain = bake('rgba32f', '--encoding', 'rgba32f');
    const truth = read(fs.readFileSync(path.join(plain, 'specular.ktx2'))).levels.map(({levelData}) => new Float32Array(levelData.slice().buffer));

    for (const encoding of encodings) {
        const folder = encoding === 'rgba32f' ? plain : bake(encoding, '--encoding', encoding);
        const file = read(fs.readFileSync(path.join(folder, 'specular.ktx2'))), wrong = [];
        if (file.vkFormat !== vkFormats[encoding]) wrong.push(`VkFormat ${file.vkFormat}`);
        if (file.pixelWidth !== 64 || file.pixelHeight !== 64 || file.pixelDepth || file.layerCount || file.faceCount !== 6) wrong.push('not a cube of 64^2');
        if (file.levelCount !== 4 || file.levels.length !== 4) wrong.push(`${file.levelCount} levels`);
        if (!file.dataFormatDescriptor[0]?.samples.length) wrong.push('no samples in the data format descriptor');
        if (file.dataFormatDescriptor[0]?.transferFunction !== 1) wrong.push('the descriptor says that it is not linear');
        if (!file.keyValue['domelight.roughness']) wrong.push('no roughness among its keys');
        if (!(file.keyValue['KTXwriter'] ?? '').startsWith('Domelight')) wrong.push('no writer among its keys');
        claim(`ktx-parse reads KTX2 in ${encoding}`, wrong, `VkFormat ${file.vkFormat}, ${file.levels.length} levels`);
    }

    // A set of three probes: its arrays of cubes, in which each cube is where docs/probes.md says.
    const probes = path.join(work, 'format-probes');
    domelight('probes', 'spheres', '--env', source, '-o', probes, '--at', '0,1,9', '--at', '9,1,0', '--at', '0,9,0', '--size', 16, '--spp', 1, '--encoding', 'rgba32f', '--quiet');
    const arrays = [['specular', 109, 16, 3, 'rgba'], ['irradiance', 109, 16, 1, 'rgba'], ['distance', 103, 16, 1, 'rg']], faults = [];
    for (const [name, format, size, levels, channels] of arrays) {
        const file = read(fs.readFileSync(path.join(probes, `${name}.ktx2`)));
        if (file.vkFormat !== format || file.pixelWidth !== size || file.layerCount !== 3 || file.faceCount !== 6 || file.levels.length !== levels)
            faults.push(`${name}: VkFormat ${file.vkFormat}, ${file.pixelWidth} texels, ${file.layerCount} layers, ${file.levels.length} levels`);
        file.levels.forEach(({levelData}, l) => {
            const bytes = 3 * 6 * (size >> l) ** 2 * 4 * channels.length;
            if (levelData.byteLength !== bytes) faults.push(`${name}: level ${l} has ${levelData.byteLength} bytes and not ${bytes}`);
        });
    }
    const {harmonics} = JSON.parse(fs.readFileSync(path.join(probes, 'probes.json'))).probes[2];
    const level = read(fs.readFileSync(path.join(probes, 'specular.ktx2'))).levels[0].levelData, texels = new Float32Array(level.slice().buffer);
    // The mean over the sphere is the first coefficient over 2 sqrt(pi).
    let sum = 0, area = 0;
    for (let k = 0; k < 6 * 256; ++k) {
        const at = j => (2 * j + 1) / 16 - 1, weight = (1 + at(k % 16) ** 2 + at((k >> 4) % 16) ** 2) ** -1.5;
        sum += weight * texels[4 * (2 * 6 * 256 + k) + 1];
        area += weight;
    }
    const mean = harmonics[0][1] / (2 * Math.sqrt(Math.PI));
    if (Math.abs(sum / area - mean) > 0.01 * mean) faults.push(`the last probe's mean is ${sum / area} by its texels, ${mean} by its harmonics`);
    claim('ktx-parse reads the cubes of a set of probes', faults, `${texels.length / 4} texels in level 0`);

    const dds = fs.readFileSync(path.join(bake('dds', '--encoding', 'rgba32f', '--format', 'dds', '--size', 16, '--levels', 5), 'specular.dds'));
    const small = read(fs.readFileSync(path.join(bake('small', '--encoding', 'rgba32f', '--size', 16, '--levels', 5), 'specular.ktx2')));
    const {images, cubemap} = parseDds(dds.buffer.slice(dds.byteOffset, dds.byteOffset + dds.length));
    const wrong = [];
    if (!cubemap || images.length !== 30) wrong.push(`${images.length} images`);
    images.forEach(({offset, length, shape}, k) => {
        const face = Math.floor(k / 5), level = small.levels[k % 5].levelData;
        const same = dds.subarray(offset, offset + length).equals(Buffer.from(level.buffer, level.byteOffset + face * length, length));
        if (!same || shape[0] !== 16 >> (k % 5)) wrong.push(`level ${k % 5} of face ${face} is not where it should be`);
    });
    claim('parse-dds finds every level of every face of a DDS cube', wrong, `${images.length} images`);

    const exr = path.join(bake('exr', '--layout', 'latlong', '--format', 'exr'), '.');
    for (const name of fs.readdirSync(exr).filter(n => n.endsWith('.exr'))) {
        const header = execFileSync('exrheader', [path.join(exr, name)], {encoding: 'utf8'}), missing = [];
        for (const word of ["channels", 'R, 16-bit floating-point'])
            if (!header.includes(word)) missing.push(`its header does not say "${word}"`);
        claim(`exrheader reads ${name}`, missing);
    }

    // Blocks decoded by other programs. Their floats, written into a KTX2 in RGBA32F, must equal what Domelight decodes, texel by texel.
    const page = await open(browser, server.url, 'blocks', log);
    const sameTexels = async (what, decoder, by, name) => {
        const levels = await call(page, decoder, {url: `/files/${name}`}), decoded = path.join(work, `${name}.decoded.ktx2`);
        replaceLevels(path.join(plain, 'specular.ktx2'), decoded, level => Buffer.from(floats(levels[level]).buffer));
        levels.forEach((_, level) => {
            const {errors} = JSON.parse(domelight('compare', path.join(work, name), decoded, '--level', level, '--json'));
            claim(`${what}, level ${level}: Domelight reads the texels that ${by} reads`,
                  errors.largest === 0 ? [] : [`they differ by up to ${errors.largest}`],
                  `${errors.pixels} texels`);
        });
        return levels;
    };
    for (const [encoding, decoder, by] of [['bc6h', 'decodeBc6h', 'the GPU'], ['uastc-hdr', 'decodeUastcHdr', 'Basis Universal']]) {
        if (!encodings.includes(encoding)) {
            skip(`decoding ${encoding} by ${by}: the program does not write it`);
            continue;
        }
        const levels = await sameTexels(encoding, decoder, by, `format-${encoding}/specular.ktx2`);
        manifest(path.join(work, `format-${encoding}`)).specular.levels.forEach((level, k) => {
            const error = relativeError(floats(levels[k]), truth[k]), ours = level.encoding_rms_error;
            claim(`${encoding}, level ${k}: ${by} reads values as far from the truth as the manifest says`,
                  Math.abs(error - ours) <= 1e-3 * ours ? [] : [`${error} and not ${ours}`], `${(100 * error).toFixed(3)} %`);
        });
    }
    if (encodings.includes('bc6h')) {
        // Random bits: all fourteen modes, all partitions, and the modes that are reserved.
        let state = 1;
        const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 24;
        replaceLevels(path.join(work, 'format-bc6h/specular.ktx2'), path.join(work, 'random.ktx2'), (_, length) => Buffer.from(Array.from({length}, random)));
        await sameTexels('BC6H of random bits', 'decodeBc6h', 'the GPU', 'random.ktx2');
    }
    await page.close();
}
