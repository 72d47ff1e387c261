import fs from 'node:fs';
import {fileURLToPath} from 'node:url';
import {defineConfig} from 'vite';

const here = (name: string) => fileURLToPath(new URL(name, import.meta.url));

// The WebAssembly module of the library (the preset `wasm`).
const module = process.env.DOMELIGHT_WASM ?? here('../build/wasm/domelight.wasm');

// The app, and every page that teaches.
const pages = fs.readdirSync(here('learn'), {recursive: true, encoding: 'utf8'}).filter(name => name.endsWith('index.html'));
const input = [here('index.html'), ...pages.map(name => here(`learn/${name}`))];

// All paths are relative, so that the files can be served from any folder of any host. The shaders that the app shares with
// the documentation lie in docs/shaders, outside this folder.
export default defineConfig({
    base: './',
    resolve: {alias: [{find: /^domelight\.wasm(?=\?)/, replacement: module}]},
    build: {outDir: '../build/web', emptyOutDir: true, target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1200, rollupOptions: {input}},
    worker: {format: 'es'},
    server: {host: '127.0.0.1', fs: {allow: ['..', module]}},
    preview: {host: '127.0.0.1'},
});
