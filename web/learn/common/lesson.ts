// What all pages that teach have in common: the frame of the page, the environment, the values of the sliders, and when the figures are drawn.

import {builtIn, fromFile, type LightSource} from '../../src/light_source';
import {environmentEndings} from '../../src/endings';
import {readHash, Values, writeHash, type Words} from '../../src/state';
import {button, element, SelectControl} from '../../src/ui/controls';
import {bindDrops, chooser} from '../../src/ui/files';
import {environmentNames} from '../../src/ui/labels';
import {whatIsMissing} from '../../src/ui/missing';
import {k_rows, Light} from './light';
import {Painter} from './painter';

const computed = [...environmentNames, ['furnace', 'Radiance 1 from everywhere']] as const;
/// Stands for a file of the user's, which no address can name.
const k_file = 'file';

/// The values of a page. They are its address too.
export interface Choices {
    environment: string;
}

export class Lesson<T extends Choices> {
    readonly light = new Light();
    readonly painter = new Painter();
    readonly values: Values<T>;
    /// Numbers of the figures, for tests.
    readonly numbers: Record<string, number> = {};
    private readonly drawings: (() => void)[] = [];
    private readonly loaders: (() => Promise<void>)[] = [];
    private readonly note = element('p', {className: 'note', role: 'status'});
    private readonly alert = element('div', {id: 'notes', role: 'alert'});
    private select!: SelectControl<T>;
    private pending = 0;
    private drawn = false;
    private failed = false;

    constructor(usual: T, words: Words<T> = {}) {
        this.values = new Values({...usual, ...readHash(location.hash, usual, {environment: computed.map(([name]) => name), ...words})}, usual);
        this.layOut();
        this.values.listen(changed => {
            const hash = writeHash({...this.state, environment: this.state.environment === k_file ? usual.environment : this.state.environment}, usual);
            history.replaceState(null, '', hash || location.pathname);
            if (changed.has('environment') && this.state.environment !== k_file) void this.open(builtIn(this.values.state.environment));
            else this.draw();
        });
        addEventListener('hashchange', () => location.reload());
        this.painter.renderer.domElement.addEventListener('webglcontextrestored', () => this.draw());
        Object.assign(window, {lesson: this});
    }

    get state(): T {
        return this.values.state;
    }
    /// Whether the figures show what was chosen.
    get ready(): boolean {
        return (this.drawn && this.pending === 0) || this.failed;
    }

    /// What has to be computed of each environment, in the order of the calls.
    onLight(load: () => Promise<void>): void {
        this.loaders.push(load);
    }
    /// What has to be drawn whenever something was chosen.
    onDraw(draw: () => void): void {
        this.drawings.push(draw);
    }
    start(): void {
        void this.open(builtIn(this.state.environment));
    }

    /// Runs work of the worker; the figures are drawn afterwards. Of several with one key, only the last that was asked for counts.
    async compute<R>(key: string, work: () => Promise<R>, done: (result: R) => void): Promise<void> {
        const turn = (this.turns.get(key) ?? 0) + 1;
        this.turns.set(key, turn);
        await this.busy(async () => {
            const result = await work();
            if (this.turns.get(key) === turn) done(result);
        });
    }
    private readonly turns = new Map<string, number>();

    /// Opens a file of the user's. If it cannot be read, the light stays as it is.
    private async openFile(file: File): Promise<void> {
        if (!(await this.open(fromFile(file)))) return;
        this.select.fill([...computed, [k_file, this.light.name]]);
        this.values.state.environment = k_file as T['environment'];
        this.select.querySelector('select')!.value = k_file;
    }

    /// Whether that went well.
    open(source: LightSource): Promise<boolean> {
        return this.busy(async () => {
            await this.light.open(source);
            for (const load of this.loaders) await load();
            const {name, readHeight} = this.light;
            this.note.textContent = readHeight > k_rows ? `${name}, reduced to ${k_rows} rows, so that every number on this page is of the same light.` : `${name}, ${readHeight} rows.`;
            this.drawn = true;
        });
    }

    private async busy(work: () => Promise<void>): Promise<boolean> {
        ++this.pending;
        let well = true;
        try {
            await work();
        } catch (error) {
            this.complain((error as Error).message);
            well = false;
        }
        --this.pending;
        if (this.drawn) this.drawNow();
        return well;
    }
    private complain(sentence: string): void {
        const note = element('div', {className: 'surface'}, element('p', {}, sentence), button('Close', () => note.remove()));
        this.alert.append(note);
        while (this.alert.children.length > 3) this.alert.firstElementChild!.remove();
    }

    private draw(): void {
        if (this.drawn) this.drawNow();
    }
    private drawNow(): void {
        if (this.painter.renderer.getContext().isContextLost()) return;
        for (const draw of this.drawings) draw();
    }

    /// The choice of the environment, and what files are dropped on.
    private layOut(): void {
        const choose = chooser('Your environment', environmentEndings, ([file]) => file && void this.openFile(file));
        this.select = new SelectControl(this.values as never, 'environment', 'Environment', computed) as never;
        const open = button('Open a file…', choose, 'A lat-long map, .hdr or .exr. It stays on this machine.');
        document.querySelector('.lead')!.after(element('section', {id: 'light', ariaLabel: 'Environment'}, this.select, open, this.note));
        const drop = element('div', {id: 'drop', hidden: true}, element('p', {}, 'Drop an environment anywhere'));
        bindDrops(drop, files => void this.openFile(files[0]!));
        document.body.append(this.alert, drop);
        const lack = whatIsMissing();
        if (lack) this.complain(lack);
        this.failed = lack !== '';
    }
}

/// Puts parts into the element that has this id.
export function fill(id: string, ...parts: (Node | string)[]): HTMLElement {
    const place = document.getElementById(id)!;
    place.append(...parts);
    return place;
}

/// A canvas with a caption under it.
export function figure(canvas: Element, caption: string | Node): HTMLElement {
    return element('figure', {}, canvas as HTMLElement, element('figcaption', {}, caption));
}
export const picture = (label: string): HTMLCanvasElement => element('canvas', {className: 'plot', role: 'img', ariaLabel: label});

/// Numbers under their names, the first of them large.
export class Facts {
    readonly root = element('dl', {className: 'facts'});
    private readonly places = new Map<string, HTMLElement>();

    set(name: string, value: string): void {
        let place = this.places.get(name);
        if (!place) {
            place = element('dd');
            this.places.set(name, place);
            this.root.append(element('div', {}, element('dt', {}, name), place));
        }
        if (place.textContent !== value) place.textContent = value;
    }
}
