// Fills the page that main.ts has laid out, and starts the app.

import {App} from './app';
import type {Baker} from './bake/baker';
import {phongLevel, sizesDownTo} from './bake/chain';
import {environmentEndings, modelEndings, partEndings, pictureEndings, probeEndings} from './endings';
import type {Session} from './served';
import {writeHash, type Store} from './state';
import {CompareSection} from './ui/compare_section';
import {button, element} from './ui/controls';
import {exportSection, save} from './ui/export_section';
import {bindKeys, keyTable} from './ui/keys';
import {helpDialog, type Layout} from './ui/layout';
import {levelsSection} from './ui/levels_section';
import {MapSection} from './ui/map_section';
import {NoiseSection} from './ui/noise_section';
import {materialSection, methodSection, pictureSection, sceneSection} from './ui/panel';
import {probesSection} from './ui/probes_section';
import {bindPointer} from './ui/pointer';
import {Hover} from './ui/hover';
import {ScreenSection} from './ui/screen_section';
import {Status} from './ui/status';
import {whatIsMissing} from './ui/missing';
import {chooser} from './ui/files';
import {TruthSection} from './ui/truth_section';

export interface Beginning {
    store: Store;
    layout: Layout;
    baker: Baker;
    session: Promise<Session | null>;
}

/// Resolves to what opens files; to null where the browser lacks something, which the page then says.
export async function start({store, layout, baker, session}: Beginning): Promise<((files: File[]) => void) | null> {
    const lack = whatIsMissing(layout.canvas);
    if (lack) {
        layout.caption.textContent = '';
        document.body.append(element('p', {className: 'surface', id: 'unable', role: 'alert'}, lack));
        return null;
    }
    const served = await session;
    const app = new App(layout.canvas, store, {working: layout.work, failed: layout.complain, told: layout.tell, drawn: () => drawn()}, baker, served);
    const openFiles = (files: File[]) => {
        layout.clear();
        void app.openFiles(files);
    };
    const choose = chooser('Environments, models and sets of probes', [...environmentEndings, ...modelEndings, ...partEndings, ...probeEndings], openFiles);
    const choosePicture = chooser('A picture to compare with', pictureEndings, ([file]) => file && void app.openPicture(file));
    const screenshot = () => {
        app.stage.showWhite(app.state);
        // Without what lies below the panel.
        const {canvas} = layout, {right, bottom} = app.stage.inset, copy = new OffscreenCanvas(Math.max(1, canvas.width - right), Math.max(1, canvas.height - bottom));
        copy.getContext('2d')!.drawImage(canvas, 0, 0);
        void copy.convertToBlob().then(blob => save(`domelight-${app.state.mode}.png`, blob, 'image/png'));
        app.redraw();
    };
    const keys = keyTable(store, {open: choose, help: () => help.showModal(), screenshot, resetView: () => app.resetView(), zoom: factor => app.zoom(factor), nextEnvironment: step => app.nextEnvironment(step), truth: () => truth.compare()});
    const help = helpDialog(keys);
    bindKeys(keys);

    const map = new MapSection(app), compare = new CompareSection(app, choosePicture), noise = new NoiseSection(app), truth = new TruthSection(app);
    if (served) truth.use(served);
    const levelOf = (exponent: number) => phongLevel(exponent, sizesDownTo(store.state.size, 8).length).toFixed(1);
    layout.tools.append(button('Open…', choose, 'Open files (O)'), button('Fit', () => app.resetView(), 'Show the whole model (R)'), button('Save', screenshot, 'Save a screenshot (P)'),
                        button('Help', () => help.showModal(), '?'), button('Fold', () => store.set({panel: false}), 'Fold the panel away (H)'));
    layout.panel.append(sceneSection(app), pictureSection(app, new ScreenSection(app, layout.canvas).parts), methodSection(app), probesSection(app), noise.root, materialSection(app, levelOf), truth.root, compare.root, map.root, levelsSection(app), exportSection(app));

    const status = new Status(app, layout.status), hover = new Hover(app, status, map);
    layout.canvas.addEventListener('dblclick', event => app.lookCloser(event.clientX / innerWidth, event.clientY / innerHeight));
    bindPointer(layout.canvas, store, factor => app.zoom(factor), (x, y) => hover.at(x, y), () => hover.leave());
    const progress = () => (store.state.other === 'truth' ? truth.progress || 'on its way' : app.stage.hasOther(store.state) ? '' : 'none is open');
    const name = () => layout.name(store.state, progress(), app.stage.mapped);
    const drawn = () => {
        name();
        status.update();
        noise.update();
        compare.update();
        hover.refresh();
    };

    const resize = () => {
        const scale = Math.min(2, devicePixelRatio), narrow = innerWidth <= 700, {panel} = store.state;
        app.resize(innerWidth * scale, innerHeight * scale, {right: panel && !narrow ? 328 * scale : 0, bottom: panel && narrow ? 0.52 * innerHeight * scale : 0});
    };
    resize();
    addEventListener('resize', () => {
        resize();
        truth.resized();
    });
    store.listen(changed => changed.has('panel') && resize());
    app.onOpened(() => {
        const {model: {name}, environmentName} = app, alone = name === 'none';
        layout.caption.textContent = alone ? environmentName : `${name} · ${environmentName}`;
        document.title = alone ? `${environmentName} – Domelight` : `${name} under ${environmentName} – Domelight`;
    });
    let timer = 0;
    store.listen(() => {
        name();
        clearTimeout(timer);
        timer = setTimeout(() => history.replaceState(null, '', writeHash(store.state) || location.pathname), 300);
    });
    addEventListener('hashchange', () => location.reload());
    Object.assign(window, {
        domelight: {
            get ready() { return app.ready; },
            app, stage: app.stage, store, openFiles: (files: File[]) => app.openFiles(files),
            paneAt: (frames: number, index: number) => app.paneAt(frames, index),
        },
    });
    store.touch('panel');
    void app.start();
    return openFiles;
}
