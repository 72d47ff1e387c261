// The truth beside the method or in its place: a picture of the same view by the path tracer of the program that serves the page, as it converges.

import type {App} from '../app';
import {askTruth, type Session, type TruthFrame, type TruthRequest} from '../served';
import type {State} from '../state';
import {button, CheckControl, element, RangeControl} from './controls';
import {note, section} from './panel';

const k_rest_ms = 400;
/// Of a picture that the program renders (docs/view.md).
const k_most_side = 8192, k_most_pixels = 2 ** 23;

export class TruthSection {
    readonly root: HTMLElement;
    /// Of the picture that is shown: what stands behind its name; empty before it comes.
    progress = '';
    private readonly text = note('Rendered by the program that serves this page, of the files on its command line.');
    private readonly unlike = note();
    private session: Session | null = null;
    private running: AbortController | null = null;
    private timer = 0;
    /// The picture that was asked for last.
    private asked = '';

    constructor(private readonly app: App) {
        const {store} = app;
        this.root = section('Truth', true, this.text, this.unlike,
            element('div', {className: 'row'}, button('Compare with the truth', () => this.compare(), 'T: beside the method, then over the whole picture, then no more')),
            new RangeControl(store, 'truthSamples', 'Samples', {min: 4, max: 12, step: 1, text: v => String(2 ** v)}),
            new RangeControl(store, 'bounces', 'Bounces', {min: 0, max: 8, step: 1}),
            new CheckControl(store, 'shadows', 'Shadows', 'Off: as a shader that has none'));
        this.root.hidden = true;
        const relevant = new Set<keyof State>(['eye', 'target', 'fov', 'turn', 'other', 'view', 'truthSamples', 'bounces', 'shadows', 'panel', 'fullResolution', 'furnace']);
        store.listen(changed => [...changed].some(key => relevant.has(key)) && this.later());
        app.onOpened(() => this.later());
    }

    use(session: Session): void {
        this.session = session;
        this.root.hidden = !session.truth;
        this.later();
    }

    /// Puts the truth beside the method, then in its place, then takes it away. Probes have shadows and indirect light: then the picture has them too.
    compare(): void {
        const {store, stage} = this.app, {other, view} = store.state, {set} = stage.probes;
        if (this.root.hidden) return this.app.events.failed('Path-traced pictures need `domelight view SCENE ENV`, which serves this page.');
        if (other === 'truth' && view !== 'one') return store.set({view: view === 'other' ? 'one' : 'other'});
        const asProbes = set && store.state.probes ? {shadows: true, bounces: Math.min(8, set.record.bounces + 1)} : {};
        store.set({other: 'truth', view: view === 'one' ? 'split' : view, ...asProbes});
    }

    /// The pane has another size.
    resized(): void {
        this.later();
    }
    /// Asks for another picture when nothing has changed for a while. Without the truth on the screen, the one that is on its way may come.
    private later(): void {
        clearTimeout(this.timer);
        const {app, root} = this, {other, view} = app.state, wanted = !root.hidden && other === 'truth' && view !== 'one';
        this.tellUnlike();
        if (JSON.stringify(this.request()) !== this.asked) this.end();
        if (wanted && !this.asked) this.timer = setTimeout(() => void this.ask(), k_rest_ms);
    }
    private end(): void {
        this.running?.abort();
        this.running = null;
        this.asked = this.progress = '';
        this.app.stage.dropPicture('truth');
    }

    /// The whole pane, also what is below the panel, in all its pixels or as many as the program renders.
    private request(): TruthRequest {
        const {state, screen: {width, height, inset: {right, bottom}}} = this.app, scale = Math.min(1, k_most_side / Math.max(width, height), Math.sqrt(k_most_pixels / (width * height)));
        const pixels = (v: number) => Math.max(1, Math.floor(v * scale));
        return {
            position: state.eye, target: state.target, fov_y_deg: state.fov,
            width: pixels(width), height: pixels(height), view_width: pixels(width - right), view_height: pixels(height - bottom),
            samples: 2 ** state.truthSamples, bounces: state.bounces, occlusion: state.shadows, rotate_y_deg: state.turn,
        };
    }
    private async ask(): Promise<void> {
        const running = (this.running = new AbortController()), request = this.request();
        this.asked = JSON.stringify(request);
        try {
            await askTruth(request, running.signal, frame => !running.signal.aborted && this.show(frame));
        } catch (error) {
            if (running.signal.aborted) return;
            this.app.events.failed((error as Error).message);
        }
    }

    private show({picture, samples, noise}: TruthFrame): void {
        this.progress = `${samples.toFixed(0)} samples`;
        this.text.textContent = `${samples.toFixed(0)} samples a pixel, noise ${(100 * noise).toPrecision(2)} % (standard error of L / (1 + L)).`;
        this.app.stage.setPicture('truth', picture);
        this.app.redraw();
    }

    /// What the page shows now and the program does not know of.
    private tellUnlike(): void {
        const {app: {model, environmentName, state}, session} = this, {scene, environment} = session ?? {};
        const unlike = [scene && model?.name !== scene.name && 'the model', environment?.[0] && !state.furnace && environmentName !== environment[0].name && 'the environment', state.furnace && 'the white furnace'].filter(Boolean);
        this.unlike.hidden = unlike.length === 0;
        this.unlike.textContent = `It does not know ${unlike.join(' and ')} that this page shows.`;
    }
}
