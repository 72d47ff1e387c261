import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {defineConfig} from 'vite';
import {makeBrdfTable} from './build_steps/brdf_table';
import {fewerDecoders, makeBasisTranscoder} from './build_steps/decoders';
import {commonParts} from './build_steps/pages';
import {preload} from './build_steps/preload';

const here = (name: string) => fileURLToPath(new URL(name, import.meta.url));

// The WebAssembly module of the library that also reads files (the preset `wasm`).
const module = process.env.DOMELIGHT_WASM ?? here('../build/wasm/domelight-files.wasm');
// The one that also writes files: beside it.
const baking = path.join(path.dirname(module), 'domelight-bake.wasm');
// Files that are made before the build.
const made = here('../build/web-made'), table = path.join(made, 'brdf_table.bin'), transcoder = path.join(made, 'basis_transcoder.js');

// The app, and every page that teaches.
const pages = fs.readdirSync(here('learn'), {recursive: true, encoding: 'utf8'}).filter(name => name.endsWith('index.html'));
const input = [here('index.html'), ...pages.map(name => here(`learn/${name}`))];
const alias = {'domelight.wasm': module, 'domelight-bake.wasm': baking, 'brdf_table.bin': table, 'basis_transcoder.js': transcoder};

// All paths are relative, so that the files can be served from any folder of any host. The shaders that the app shares with
// the documentation lie in docs/shaders, outside this folder.
export default defineConfig(async () => {
    fs.mkdirSync(made, {recursive: true});
    await makeBrdfTable(module, table);
    makeBasisTranscoder(here('node_modules/three/examples/jsm/libs/basis/basis_transcoder.js'), transcoder);
    return {
        base: './',
        plugins: [commonParts(), preload('start'), fewerDecoders()],
        resolve: {alias: Object.entries(alias).map(([name, replacement]) => ({find: new RegExp(`^${name.replace('.', '\\.')}(?=\\?)`), replacement}))},
        build: {outDir: '../build/web', emptyOutDir: true, target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1200, rollupOptions: {input}},
        worker: {format: 'es'},
        server: {host: '127.0.0.1', fs: {allow: ['..', module]}},
        preview: {host: '127.0.0.1'},
    };
});
