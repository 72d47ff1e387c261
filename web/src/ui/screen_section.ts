// Whether the picture has more than white (HDR), where the screen, the browser and the user want it, and what the page says of that.

import type {App} from '../app';
import type {HdrScreen} from '../render/hdr_screen';
import {CheckControl, element, onlyWhere, RangeControl} from './controls';
import {note} from './panel';

export class ScreenSection {
    readonly parts: HTMLElement[];
    private readonly text = note();
    private readonly bright = matchMedia('(dynamic-range: high)');
    private readonly controls: HTMLElement;
    private screen: HdrScreen | null = null;
    /// Grows with each change: what an earlier one has begun does not count.
    private turn = 0;

    constructor(
        private readonly app: App,
        private readonly canvas: HTMLCanvasElement,
    ) {
        const {store} = app;
        const peak = new RangeControl(store, 'peak', 'Brightest, in units of white', {min: 1.5, max: 16, step: 0.5, title: 'Highlights come near it. More than the screen can show is cut off by it'});
        this.controls = element('div', {className: 'stack'}, new CheckControl(store, 'hdr', 'Highlights brighter than white (HDR)'), onlyWhere(store, peak, s => s.hdr));
        this.parts = [this.controls, this.text];
        this.bright.addEventListener('change', () => void this.choose());
        store.listen(changed => changed.has('hdr') && void this.choose());
        void this.choose();
    }

    private async choose(): Promise<void> {
        const {app, bright, canvas} = this, turn = ++this.turn;
        this.controls.hidden = !bright.matches;
        this.use(null);
        if (!bright.matches) return this.tell('SDR: this screen, or this browser, shows nothing brighter than white.');
        if (!app.state.hdr) return this.tell('SDR: white is the brightest. The screen could show more.');
        const {HdrScreen} = await import('../render/hdr_screen'), screen = await HdrScreen.create(canvas);
        if (turn !== this.turn) return screen?.dispose();
        if (!screen) return this.tell('SDR: the screen shows more than white, but this browser has no canvas for it (WebGPU with extended tone mapping).');
        void screen.lost.then(() => {
            if (turn !== this.turn) return;
            this.use(null);
            this.tell('SDR: the graphics card was lost that showed more than white.');
        });
        this.use(screen);
        this.tell('HDR: 1 is the white of this page; highlights are brighter.');
    }
    private use(screen: HdrScreen | null): void {
        const {app, canvas} = this;
        if (this.screen === screen) return;
        app.stage.useScreen(screen);
        if (!screen && app.ready) app.stage.showWhite(app.state);  // before the canvas of WebGL2 can be seen
        this.screen?.dispose();
        this.screen = screen;
        if (screen) {
            screen.canvas.className = 'hdr';
            screen.canvas.setAttribute('aria-hidden', 'true');
            canvas.after(screen.canvas);
        }
        app.redraw();
    }
    private tell(text: string): void {
        this.text.textContent = text;
        this.app.dynamicRange = this.screen ? 'HDR' : 'SDR';
    }
}
