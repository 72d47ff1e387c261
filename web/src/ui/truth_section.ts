// The picture of the path tracer that serves the page, beside a method: asked for when the camera rests, shown as it converges.

import type {App} from '../app';
import {askTruth, type Session, type TruthFrame} from '../served';
import {button, CheckControl, element, RangeControl} from './controls';
import {note, section} from './panel';

const k_rest_ms = 400;

export class TruthSection {
    readonly root: HTMLElement;
    private readonly text = note('Rendered by the program that serves this page, of the files on its command line.');
    private running: AbortController | null = null;
    private timer = 0;

    constructor(private readonly app: App) {
        const {store} = app;
        this.root = section('Truth', true, this.text,
            element('div', {className: 'row'}, button('Compare with the truth', () => this.compare(), 'T')),
            new RangeControl(store, 'truthSamples', 'Samples', {min: 4, max: 12, step: 1, text: v => String(2 ** v)}),
            new RangeControl(store, 'bounces', 'Bounces', {min: 0, max: 8, step: 1}),
            new CheckControl(store, 'shadows', 'Shadows', 'Off: as a shader that has none'));
        this.root.hidden = true;
        const asked = new Set(['eye', 'target', 'fov', 'turn', 'other', 'view', 'truthSamples', 'bounces', 'shadows', 'panel', 'fullResolution']);
        store.listen(changed => [...changed].some(key => asked.has(key)) && this.later());
    }

    use(session: Session): void {
        this.root.hidden = !session.truth;
        this.later();
    }

    /// Puts the truth beside the method, or takes it away again. Probes have shadows and indirect light: then the picture has them too.
    compare(): void {
        const {store, stage} = this.app, {other, view} = store.state, {set} = stage.probes;
        if (this.root.hidden) return this.app.events.failed('Path-traced pictures need `domelight view SCENE ENV`, which serves this page.');
        if (other === 'truth' && view !== 'one') return store.set({view: 'one'});
        const asProbes = set && store.state.probes ? {shadows: true, bounces: Math.min(8, set.record.bounces + 1)} : {};
        store.set({other: 'truth', view: view === 'one' ? 'split' : view, ...asProbes});
    }

    /// Asks anew when nothing has changed for a while.
    private later(): void {
        clearTimeout(this.timer);
        this.running?.abort();
        this.running = null;
        const {other, view} = this.app.state;
        if (!this.root.hidden && other === 'truth' && view !== 'one') this.timer = setTimeout(() => void this.ask(), k_rest_ms);
    }

    private async ask(): Promise<void> {
        const {state, stage} = this.app, running = (this.running = new AbortController());
        const {width, height} = stage.panes[0], {right, bottom} = stage.inset;
        try {
            await askTruth({
                position: state.eye, target: state.target, fov_y_deg: state.fov, width: Math.round(width - right), height: Math.round(height - bottom),
                samples: 2 ** state.truthSamples, bounces: state.bounces, occlusion: state.shadows, rotate_y_deg: state.turn,
            }, running.signal, frame => this.show(frame, width, height));
        } catch (error) {
            if (!running.signal.aborted) this.app.events.failed((error as Error).message);
        }
    }

    /// width, height: of the pane when the picture was asked for. Its resolution may have changed since.
    private show({picture, samples, noise}: TruthFrame, width: number, height: number): void {
        this.text.textContent = `${samples.toFixed(0)} samples a pixel, noise ${(100 * noise).toPrecision(2)} % (standard error of L / (1 + L)).`;
        this.app.stage.setPicture(extended(picture, width, height));
        this.app.redraw();
    }
}

/// The picture in the upper left of one that also covers what is below the panel.
function extended(picture: TruthFrame['picture'], width: number, height: number): TruthFrame['picture'] {
    if (picture.width === width && picture.height === height) return picture;
    const pixels = new Float32Array(3 * width * height), across = Math.min(width, picture.width);
    for (let y = 0; y < Math.min(height, picture.height); ++y) pixels.set(picture.pixels.subarray(3 * y * picture.width, 3 * (y * picture.width + across)), 3 * y * width);
    return {width, height, pixels};
}
