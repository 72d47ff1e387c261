// What all pages that teach have in common: the frame of the page, the environment, the values of the sliders, and when the figures are drawn.

import {builtIn, fromFile, type LightSource} from '../../src/light_source';
import {environmentEndings} from '../../src/endings';
import {readHash, Values, writeHash, type Words} from '../../src/state';
import {button, element, SelectControl} from '../../src/ui/controls';
import {bindDrops, chooser} from '../../src/ui/files';
import {environmentNames} from '../../src/ui/labels';
import {whatIsMissing} from '../../src/ui/missing';
import {k_rows, Light} from './light';
import {Outdated, Painter} from './painter';

const computed = [...environmentNames, ['furnace', 'Radiance 1 from everywhere']] as const;
/// Stands for a file of the user's, which no address can name.
const k_file = 'file';
/// How long a drawing goes on with what was chosen before something else was, so that all its parts are drawn now and then while a slider is dragged.
const k_patience_ms = 120;

/// The values of a page. They are its address too.
export interface Choices {
    environment: string;
}

export class Lesson<T extends Choices> {
    readonly light = new Light();
    readonly painter = new Painter(() => this.outdated);
    readonly values: Values<T>;
    /// Numbers of the figures, for tests.
    readonly numbers: Record<string, number> = {};
    private drawing: () => Promise<void> = async () => {};
    private refining: () => Promise<boolean> = async () => false;
    private readonly loaders: (() => Promise<void>)[] = [];
    private readonly note = element('p', {className: 'note', role: 'status'});
    private readonly alert = element('div', {id: 'notes', role: 'alert'});
    private select!: SelectControl<T>;
    /// The last one of the user's that could be read.
    private file?: File;
    private opening: Promise<unknown> = Promise.resolve();
    private pending = 0;
    /// Whether there is a light, something was chosen that is not drawn yet, what was chosen is drawn, and whether something is being drawn or refined.
    private lit = false;
    private wanted = false;
    private drawn = false;
    private running = false;
    /// When the last drawing began.
    private begun = 0;
    private failed = false;

    constructor(usual: T, words: Words<T> = {}) {
        this.values = new Values({...usual, ...readHash(location.hash, usual, {environment: computed.map(([name]) => name), ...words})}, usual);
        this.layOut();
        this.values.listen(changed => {
            const {environment} = this.state, hash = writeHash({...this.state, environment: environment === k_file ? usual.environment : environment}, usual);
            history.replaceState(null, '', hash || location.pathname);
            this.leadOn();
            if (changed.has('environment')) void this.open(environment === k_file ? fromFile(this.file!) : builtIn(environment));
            else this.draw();
        });
        this.leadOn();
        addEventListener('hashchange', () => location.reload());
        this.painter.renderer.domElement.addEventListener('webglcontextrestored', () => this.draw());
        Object.assign(window, {lesson: this});
    }

    get state(): T {
        return this.values.state;
    }
    /// Whether the figures show what was chosen.
    get ready(): boolean {
        return (this.drawn && this.pending === 0 && !this.wanted) || this.failed;
    }
    private get outdated(): boolean {
        return (this.wanted || this.pending > 0) && performance.now() - this.begun > k_patience_ms;
    }

    /// What has to be computed of each environment, in the order of the calls.
    onLight(load: () => Promise<void>): void {
        this.loaders.push(load);
    }
    /// What has to be drawn whenever something was chosen, and then again and again while it returns true and nothing else is chosen. One of them runs at a time.
    onDraw(draw: () => Promise<void>, refine = this.refining): void {
        this.drawing = draw;
        this.refining = refine;
    }
    start(): void {
        void this.open(builtIn(this.state.environment));
    }

    /// What the worker answers, in a drawing.
    async answer<R>(asked: Promise<R>): Promise<R> {
        const result = await asked;
        this.painter.check();
        return result;
    }

    /// Opens a file of the user's. If it cannot be read, the light stays as it is.
    private async openFile(file: File): Promise<void> {
        if (!(await this.open(fromFile(file)))) return;
        this.file = file;
        this.select.fill([...computed, [k_file, this.light.name]]);
        this.values.state.environment = k_file as T['environment'];
        this.select.querySelector('select')!.value = k_file;
    }

    /// Whether that went well. One environment is opened after the other.
    open(source: LightSource): Promise<boolean> {
        ++this.pending;
        const opened = this.opening.then(() => this.use(source)).then(() => true, (error: Error) => {
            this.complain(error.message);
            return false;
        });
        this.opening = opened.then(() => {
            --this.pending;
            this.draw();
        });
        return opened;
    }
    private async use(source: LightSource): Promise<void> {
        await this.light.open(source);
        for (const load of this.loaders) await load();
        const {readHeight} = this.light, name = computed.find(([key]) => key === this.light.name)?.[1].replace(/ \(.*/, '') ?? this.light.name;
        this.note.textContent = readHeight > k_rows ? `${name}, reduced to ${k_rows} rows, so that every number on this page is of the same light.` : `${name}, ${readHeight} rows.`;
        this.lit = true;
    }
    private complain(sentence: string): void {
        const note = element('div', {className: 'surface'}, element('p', {}, sentence), button('Close', () => note.remove()));
        this.alert.append(note);
        while (this.alert.children.length > 3) this.alert.firstElementChild!.remove();
    }

    /// Draws, now or after what is being drawn.
    draw(): void {
        this.wanted = true;
        if (!this.running) void this.run();
    }
    private async run(): Promise<void> {
        this.running = true;
        while (this.lit && this.pending === 0 && !this.painter.renderer.getContext().isContextLost()) {
            try {
                if (this.wanted) await this.drawOnce();
                else if (!(await this.refining())) break;
            } catch (error) {
                if (error instanceof Outdated) continue;
                this.complain((error as Error).message);
                break;
            }
        }
        this.running = false;
    }
    private async drawOnce(): Promise<void> {
        this.drawn = this.wanted = false;
        this.begun = performance.now();
        try {
            await this.drawing();
            this.drawn = true;
        } catch (error) {
            if (error instanceof Outdated) this.wanted = true;
            throw error;
        }
    }

    /// The neighbouring pages open with the same environment.
    private leadOn(): void {
        const {environment} = this.state, hash = environment === k_file || environment === computed[0][0] ? '' : `environment=${environment}`;
        for (const link of document.querySelectorAll<HTMLAnchorElement>('footer a[rel]')) link.hash = hash;
    }
    /// The choice of the environment, and what files are dropped on.
    private layOut(): void {
        const choose = chooser('Your environment', environmentEndings, ([file]) => file && void this.openFile(file));
        this.select = new SelectControl(this.values as never, 'environment', 'Environment', computed) as never;
        const open = button('Open a file…', choose, 'An environment: .hdr, .exr, .ktx2, .dds and others, lat-long or a cube. It stays on this machine.');
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
