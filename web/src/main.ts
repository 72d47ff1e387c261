// Starts the app.

import {App} from './app';
import {Store} from './state';

const canvas = document.createElement('canvas');
document.body.append(canvas);
const app = new App(canvas, new Store(location.hash), {working: () => {}, failed: console.error, opened: () => {}, drawn: () => {}});
const resize = () => app.resize(innerWidth, innerHeight);
resize();
addEventListener('resize', resize);
addEventListener('dragover', event => event.preventDefault());
addEventListener('drop', event => {
    event.preventDefault();
    void app.openFiles(event.dataTransfer?.files ?? []);
});
Object.assign(window, {
    domelight: {
        get ready() { return app.ready; },
        stage: app.stage, store: app.store, openFiles: (files: File[]) => app.openFiles(files),
        paneAt: (frames: number, index: number) => app.paneAt(frames, index),
    },
});
void app.start();
