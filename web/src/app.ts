// What the page does: opens files, has them filtered, and draws until the picture is done.

import {Baker} from './bake/baker';
import type {Latlong} from './bake/types';
import {readPane} from './render/read_back';
import {Stage} from './render/stage';
import {builtInModels, type Model} from './scene/built_in';
import {viewOf} from './scene/framing';
import {loadModel} from './scene/load_model';
import {studio, whiteFurnace} from './scene/studio';
import {Store, type Mode, type State} from './state';

const isModel = (name: string) => /\.(glb|gltf)$/i.test(name);
const builtInEnvironments: Record<string, () => Latlong> = {studio, furnace: whiteFurnace};
/// Frames that are averaged until nothing would be seen to change.
const k_frames = 64;
const k_noisy_frames = 4096;

/// What happens, for whoever shows it.
export interface Events {
    /// Work that is under way, as a phrase; empty when there is none.
    working: (what: string) => void;
    /// A sentence on what is wrong with a file.
    failed: (sentence: string) => void;
    /// Another model or environment is shown.
    opened: () => void;
    /// A frame was drawn.
    drawn: () => void;
}

export class App {
    readonly baker = new Baker();
    readonly stage: Stage;
    model!: Model;
    environmentName = '';
    /// Timings of the last environment, in milliseconds.
    readonly timings = {open: 0, bake: 0};
    private readonly jobs = new Set<string>();
    private needed = {phong: false, tables: 0};
    private dirty = false;
    private environment = 0;
    private waiting: {frames: number; index: number; resolve: (base64: string) => void}[] = [];

    constructor(
        canvas: HTMLCanvasElement,
        readonly store: Store,
        private readonly events: Events,
    ) {
        this.stage = new Stage(canvas);
        store.listen(changed => this.react(changed));
    }

    get state(): State {
        return this.store.state;
    }
    /// Whether everything that was asked for has been computed.
    get ready(): boolean {
        return this.jobs.size === 0 && this.stage.panes[0].count > 0;
    }

    async start(): Promise<void> {
        const {state} = this;
        this.showModel(builtInModels[state.model] ?? builtInModels.spheres!, true);
        const brdf = this.work('BRDF table', async () => this.stage.setBrdf(await this.baker.brdf(64)));
        await this.useBuiltIn(state.environment);
        await brdf;
    }

    /// Opens whatever was dropped or chosen: a model, an environment, or both; the other files are those that a .gltf refers to.
    async openFiles(files: Iterable<File>): Promise<void> {
        const all = [...files], siblings = new Map(all.map(file => [file.name, file]));
        const models = all.filter(file => isModel(file.name));
        const environments = models.some(file => /\.gltf$/i.test(file.name)) ? all.filter(file => /\.(hdr|exr|env|dds)$/i.test(file.name))
                                                                            : all.filter(file => !isModel(file.name));
        for (const file of models) await this.work(`reading ${file.name}`, () => this.openModel(file, siblings));
        for (const file of environments) await this.work(`reading ${file.name}`, () => this.openEnvironment(file));
    }

    showModel(make: (() => Model) | Model, keepView = false): void {
        this.model = typeof make === 'function' ? make() : make;
        const {state} = this, known = keepView && state.eye.some(v => v !== 0);
        this.stage.setModel(this.model.root);
        if (!known) this.resetView();
        this.events.opened();
    }
    resetView(): void {
        const view = viewOf(this.model, this.stage.panes[0].width / this.stage.panes[0].height);
        this.store.set({eye: view.eye, target: view.target, fov: view.fovDeg});
    }

    resize(width: number, height: number): void {
        this.stage.resize(width, height);
        this.redraw();
    }
    redraw(): void {
        if (!this.dirty) requestAnimationFrame(() => this.frame());
        this.dirty = true;
    }

    /// Modes that are on the screen.
    get shown(): Mode[] {
        return this.state.view === 'one' ? [this.state.mode] : [this.state.mode, this.state.other];
    }

    async useBuiltIn(name: string): Promise<void> {
        const make = builtInEnvironments[name] ?? studio;
        await this.work('filtering', async () => this.light(await this.baker.use(name, make())));
    }
    private async openModel(file: File, siblings: Map<string, File>): Promise<void> {
        this.showModel(await loadModel(file.name, await file.arrayBuffer(), siblings));
    }
    private async openEnvironment(file: File): Promise<void> {
        await this.light(await this.baker.open(file.name, await file.arrayBuffer()));
    }

    /// Lights the model by an environment that the worker has opened.
    private async light(info: Awaited<ReturnType<Baker['open']>>): Promise<void> {
        const bake = await this.baker.bake(this.state.size);
        ++this.environment;
        this.needed = {phong: false, tables: 0};
        this.environmentName = info.name;
        this.timings.open = info.milliseconds;
        this.timings.bake = bake.milliseconds;
        this.stage.setEnvironment(info);
        this.stage.setBake(bake);
        await this.provide();
        this.events.opened();
        this.redraw();
    }

    /// Has the maps computed that the modes on the screen need and that do not exist yet.
    private async provide(): Promise<void> {
        const {shown, state} = this, environment = this.environment;
        const current = () => environment === this.environment;
        if (shown.includes('phong') && !this.needed.phong) {
            this.needed.phong = true;
            const chain = await this.baker.phong(state.size);
            if (current()) this.stage.setPhong(chain);
        }
        if (shown.includes('monte-carlo') && this.needed.tables !== state.rows) {
            this.needed.tables = state.rows;
            const tables = await this.baker.tables(state.rows);
            if (current()) this.stage.setTables(tables);
        }
    }

    private react(changed: Set<keyof State>): void {
        if (changed.has('environment')) void this.useBuiltIn(this.state.environment);
        if (changed.has('model') && builtInModels[this.state.model]) this.showModel(builtInModels[this.state.model]!);
        if (changed.has('size')) void this.work('filtering', async () => this.stage.setBake(await this.baker.bake(this.state.size)));
        void this.work('filtering', () => this.provide());
        const onlyShown = new Set<keyof State>(['exposure', 'tonemap', 'divider', 'panel']);
        if ([...changed].some(key => !onlyShown.has(key))) this.stage.restart();
        this.redraw();
    }

    /// Runs work that takes a while. What goes wrong is told, and the page stays as it is.
    private async work(what: string, task: () => Promise<void>): Promise<void> {
        const job = `${what} ${performance.now()}`;
        this.jobs.add(job);
        this.events.working(what);
        try {
            await task();
        } catch (error) {
            this.events.failed((error as Error).message);
        } finally {
            this.jobs.delete(job);
            if (this.jobs.size === 0) this.events.working('');
            this.redraw();
        }
    }

    /// For tests: a pane when it has averaged this many frames, in base64.
    paneAt(frames: number, index: number): Promise<string> {
        this.redraw();
        return new Promise(resolve => this.waiting.push({frames, index, resolve}));
    }

    private frame(): void {
        this.dirty = false;
        const {state, stage} = this;
        stage.apply(state);
        let unfinished = false;
        this.shown.forEach((mode, k) => {
            const pane = stage.panes[k]!, limit = mode === 'monte-carlo' ? k_noisy_frames : k_frames;
            if (pane.count < limit) stage.advance(pane, mode);
            unfinished ||= pane.count < limit;
        });
        stage.show(state);
        this.events.drawn();
        this.waiting = this.waiting.filter(({frames, index, resolve}) => stage.panes[index]!.count !== frames || void resolve(readPane(stage, index)));
        if (unfinished) this.redraw();
    }
}
