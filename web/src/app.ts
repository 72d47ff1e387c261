// What the page does: opens files, has them filtered, and draws until the picture is done.

import type {Baker} from './bake/baker';
import {brdfTable} from './bake/brdf_table';
import type {Bake, BrdfTable, Source} from './bake/types';
import {bakeFiles} from './export/bake_files';
import type {BakedFiles} from './export/export_worker';
import {endsIn, modelEndings, otherModelEndings} from './endings';
import {Jobs, type JobEvents} from './jobs';
import {builtIn, builtInEnvironments, exposureFor, fromFile, fromServed, openSource, type LightSource} from './light_source';
import {LiveCubes} from './render/live_cubes';
import {loadProbes, splitFiles} from './probes/load';
import {readPane} from './render/read_back';
import {Stage} from './render/stage';
import {builtInModels, type Model} from './scene/built_in';
import {moveModel} from './scene/motion';
import {viewOf} from './scene/framing';
import {Resolution} from './resolution';
import {loadModel} from './scene/load_model';
import {fetchFile, type Session} from './served';
import {isPicture, Store, type Mode, type State} from './state';

/// Frames that are averaged until nothing would be seen to change.
const k_frames = 64;
/// What an object sees of its neighbours depends on these.
const seenByObjects = new Set<keyof State>(['live', 'lights', 'turn', 'override', 'color', 'metalness', 'roughness', 'multipleScattering', 'irradiance', 'occlusion', 'diffuseWeight', 'bentLookup']);
/// Stops from a good exposure at which hardly anything is seen.
const k_too_bright_ev = 3.5, k_too_dark_ev = 6;
/// Height of what lies over the picture above and below, in CSS pixels.
const k_bars = 64;
const k_noisy_frames = 4096;
/// Until it is asked again whether the graphics card has done its work.
const k_pause_ms = 4;

export interface Events extends JobEvents {
    /// A sentence on what was repaired or guessed.
    told: (sentence: string) => void;
    /// A frame was drawn.
    drawn: () => void;
}

export class App {
    readonly stage: Stage;
    model!: Model;
    environmentName = '';
    /// What the picture is shown with.
    dynamicRange: 'SDR' | 'HDR' = 'SDR';
    /// What was repaired in the environment, and what its file leaves open.
    warnings: readonly string[] = [];
    bake?: Bake;
    brdf?: BrdfTable;
    /// Of the Phong chain; 0 before it exists.
    phongLevels = 0;
    /// Milliseconds of the last environment.
    readonly timings = {open: 0, bake: 0};
    readonly liveCubes: LiveCubes;
    private readonly jobs: Jobs;
    private movingSince: number | null = null;
    private needed = {phong: false, rows: 0};
    private source: LightSource;
    /// What can be shown, by name: what is computed here and what was opened.
    readonly environments = new Map<string, LightSource>(Object.keys(builtInEnvironments).map(name => [name, builtIn(name)]));
    readonly models = new Map<string, () => Model | Promise<Model>>(Object.entries(builtInModels));
    /// The exposure that was chosen here and not by the user.
    private adapted: number | null = null;
    /// An environment that could not be read as what it was taken for.
    private refused: {name: string; source: LightSource} | null = null;
    private light = 0;
    private readonly resolution = new Resolution();
    private drawnScale = 1;
    /// Pixels of the screen, and what of them the panel covers.
    screen = {width: 1, height: 1, inset: {right: 0, bottom: 0}};
    private scheduled = false;
    private readonly openedListeners: (() => void)[] = [];
    private readonly phongListeners: (() => void)[] = [];
    private waiting: {frames: number; index: number; resolve: (base64: Promise<string>) => void}[] = [];

    constructor(
        canvas: HTMLCanvasElement,
        readonly store: Store,
        readonly events: Events,
        readonly baker: Baker,
        /// What `domelight view` serves; null on a static host.
        readonly served: Session | null = null,
    ) {
        this.stage = new Stage(canvas);
        this.jobs = new Jobs(events);
        this.liveCubes = new LiveCubes(this.stage, baker);
        this.source = builtIn(store.state.environment);
        canvas.addEventListener('webglcontextlost', () => events.working('waiting for the graphics card'));
        canvas.addEventListener('webglcontextrestored', () => {
            events.working('');
            this.stage.restore();
            this.redraw();
        });
        store.listen(changed => this.react(changed));
    }

    get state(): State {
        return this.store.state;
    }
    /// Whether everything that was asked for has been computed and drawn once.
    get ready(): boolean {
        return this.jobs.idle && this.bake !== undefined && this.stage.panes[0].count > 0;
    }
    get levels(): number {
        return this.bake?.specular.levels.length ?? 0;
    }
    /// Drawn pixels per pixel of the screen, along each side.
    get reduced(): number {
        return this.state.fullResolution ? 1 : this.resolution.scale;
    }
    /// Frames in the pane that has the fewest.
    get least(): number {
        return Math.min(...this.shown.map((_, k) => this.stage.panes[k]!.count));
    }
    /// Modes that are on the screen, the left one first.
    get shown(): Mode[] {
        const {view, mode, other} = this.state;
        return view === 'one' || isPicture(other) ? [mode] : [mode, other];
    }
    /// Calls back whenever another model or environment is shown.
    onOpened(listener: () => void): void {
        this.openedListeners.push(listener);
    }
    /// Calls back when the Phong chain of the environment has been made.
    onPhong(listener: () => void): void {
        this.phongListeners.push(listener);
    }
    private opened(): void {
        for (const listener of this.openedListeners) listener();
    }

    async start(): Promise<void> {
        const keepView = this.state.eye.some(v => v !== 0);  // that of the address
        this.showModel((builtInModels[this.state.model] ?? builtInModels.spheres!)(), keepView);
        const {served} = this, table = this.work('fetching the BRDF table', async () => this.stage.setBrdf((this.brdf = await brdfTable())));
        if (served?.environment[0]) this.source = fromServed(served.environment[0]);
        if (!(await this.relight()) && served?.environment[0]) {
            this.source = builtIn(this.state.environment);
            await this.relight();
        } else if (served?.environment[0]) this.environments.set(served.environment[0].name, this.source);
        const {scene} = served ?? {};
        if (scene) await this.useModel(scene.name, async () => loadModel(this.stage.renderer, scene.name, await (await fetchFile(scene)).arrayBuffer(), new Map(), scene.url.replace(/[^/]*$/, '')), keepView);
        if (served?.probes.length) await this.work('reading the probes', async () => this.openProbes(await Promise.all(served.probes.map(fetchFile))));
        await table;
    }

    /// Opens whatever was dropped or chosen: models, environments, sets of probes, or all of them. With a .gltf, pictures are its textures.
    async openFiles(files: Iterable<File>): Promise<void> {
        const {set, rest: all} = splitFiles([...files]), siblings = new Map(all.map(file => [file.name, file])), withGltf = all.some(file => endsIn(file.name, ['.gltf'])), isModel = (name: string) => endsIn(name, modelEndings);
        const environments = all.filter(({name}) => !isModel(name) && (!withGltf || endsIn(name, ['.hdr', '.exr'])));
        for (const file of all.filter(({name}) => isModel(name))) await this.useModel(file.name, async () => loadModel(this.stage.renderer, file.name, await file.arrayBuffer(), siblings));
        for (const file of environments) {
            if (endsIn(file.name, otherModelEndings)) this.events.failed(`${file.name}: models are read as .glb or .gltf. Convert it first, for instance with Blender.`);
            else await this.useLight(file.name, fromFile(file));
        }
        if (set.length > 0) await this.work('reading the probes', () => this.openProbes(set));
    }
    private async openProbes(files: File[]): Promise<void> {
        this.stage.setProbes(await loadProbes(files));
        this.opened();
    }
    /// Lights by another environment, which can be chosen again from then on. One that cannot be read changes nothing.
    private async useLight(name: string, source: LightSource): Promise<void> {
        const before = this.source;
        this.source = source;
        this.refused = null;
        if (await this.relight(`reading ${name}`)) {
            this.environments.set(name, source);
            this.store.set({furnace: false});
            this.adaptExposure();
        } else {
            this.source = before;
            this.refused = {name, source};
        }
    }
    chooseEnvironment(name: string): void {
        const source = this.environments.get(name);
        if (!source || name === this.environmentName) return;
        // The address tells of those that are computed here.
        if (name in builtInEnvironments && this.state.environment !== name) this.store.set({environment: name});
        else void this.useLight(name, source);
    }
    /// The one after the shown one, or before it.
    nextEnvironment(step: number): void {
        const names = [...this.environments.keys()].filter(name => name !== 'furnace'), at = names.indexOf(this.environmentName);
        this.chooseEnvironment(names[(at + step + names.length) % names.length]!);
    }
    /// For the mean of the light.
    get goodExposure(): number {
        return this.bake ? exposureFor(this.bake.sh) : 0;
    }
    /// Light that would leave nothing but black or white is given another exposure, and the page says so.
    private adaptExposure(): void {
        const {goodExposure, state} = this, exposure = state.exposure === this.adapted ? 0 : state.exposure;
        this.adapted = null;
        if (goodExposure - exposure > -k_too_bright_ev && goodExposure - exposure < k_too_dark_ev) return this.store.set({exposure});
        this.store.set({exposure: (this.adapted = goodExposure)});
        this.events.told(`${this.environmentName} is ${goodExposure < exposure ? 'bright' : 'dark'}: the exposure is now ${goodExposure.toFixed(1)} EV.`);
    }
    private useModel(name: string, load: () => Model | Promise<Model>, keepView = false): Promise<boolean> {
        return this.work(`reading ${name}`, async () => {
            this.showModel(await load(), keepView);
            this.models.set(name, load);
            for (const sentence of this.model.notes ?? []) this.events.told(`${name}: ${sentence}`);
        });
    }
    chooseModel(name: string): void {
        const load = this.models.get(name);
        if (!load || name === this.model.name) return;
        if (name in builtInModels && this.state.model !== name) this.store.set({model: name});
        else void this.useModel(name, load);
    }
    /// Has the files of an engine baked. size: of level 0; 0: the engine's own. show: is given them.
    export(engine: string, size: number, show: (baked: BakedFiles) => void): Promise<boolean> {
        const what = `baking for ${engine}`, tell = (part: number) => this.events.working(`${what}, ${Math.floor(100 * part)} %`);
        return this.work(what, async () => show(await bakeFiles({source: await this.shownSource(), engine, size}, tell)));
    }
    /// A picture of the truth, to compare with.
    openPicture(file: File): Promise<boolean> {
        return this.work(`reading ${file.name}`, async () => {
            this.stage.setPicture('picture', await this.baker.picture(file.name, await file.arrayBuffer()));
            this.store.set({other: 'picture', view: this.state.view === 'one' ? 'split' : this.state.view});
        });
    }

    showModel(model: Model, keepView = false): void {
        this.model = model;
        this.stage.setModel(model.root);
        if (!keepView) this.resetView();
        this.liveCubes.invalidate();
        this.opened();
        this.redraw();
    }
    async useVariant(index: number | null): Promise<void> {
        await this.work('changing the materials', async () => {
            await this.model.useVariant?.(index);
            this.stage.setModel(this.model.root);
        });
    }
    /// Comes nearer to the surface at a point of the picture, which becomes the middle; beside the model, shows all of it. x, y: 0 to 1, from the upper left corner.
    lookCloser(x: number, y: number): void {
        const point = this.stage.surfaceAt(x, y)?.toArray(), {eye, target} = this.state;
        if (!point) return this.resetView();
        this.store.set({target: point, eye: point.map((v, k) => v + 0.5 * (eye[k]! - target[k]!)) as [number, number, number]});
    }
    /// Comes nearer or goes farther; without a model, sees less or more of the environment. factor: of the distance.
    zoom(factor: number): void {
        const {eye, target, fov} = this.state;
        if (this.model.name === 'none') this.store.set({fov: Math.min(120, Math.max(2, fov * factor))});
        else this.store.set({eye: eye.map((v, k) => target[k]! + (v - target[k]!) * factor) as [number, number, number]});
    }
    resetView(): void {
        // The name above and the methods below lie over the picture.
        const {height, inset} = this.screen, bars = (2 * k_bars * Math.min(2, devicePixelRatio)) / (height - inset.bottom);
        const view = viewOf(this.model, this.stage.freeAspect, this.state.panel && bars < 0.4 ? 1 / (1 - bars) : 1.05);
        this.store.set({eye: view.eye, target: view.target, fov: view.fovDeg});
    }

    /// width, height: of the screen, in its own pixels. inset: what of them the panel covers.
    resize(width: number, height: number, inset: {right: number; bottom: number}): void {
        this.screen = {width, height, inset};
        const scale = (this.drawnScale = this.reduced), scaled = (v: number) => Math.max(1, Math.round(v * scale));
        this.stage.resize(scaled(width), scaled(height), {right: inset.right * scale, bottom: inset.bottom * scale});
        this.redraw();
    }
    /// Draws as many pixels as are right now. Whether that has changed.
    private follow(): boolean {
        const {width, height, inset} = this.screen, changed = this.drawnScale !== this.reduced;
        if (changed) this.resize(width, height, inset);
        return changed;
    }
    redraw(): void {
        if (!this.scheduled) requestAnimationFrame(() => this.frame());
        this.scheduled = true;
    }

    private shownSource(): Promise<Source> {
        return (this.state.furnace ? builtIn('furnace') : this.source)(this.state.projection);
    }
    /// Reads and filters the environment that is chosen now. Whether that went well.
    private relight(what = 'filtering the environment'): Promise<boolean> {
        return this.work(what, async () => {
            const info = await openSource(this.baker, await this.shownSource());
            for (const warning of info.warnings) this.events.told(`${info.name}: ${warning}`);
            const [bake, map] = await Promise.all([this.baker.bake(this.state.size), this.stage.upload(info)]);
            ++this.light;
            this.needed = {phong: false, rows: 0};
            this.phongLevels = 0;
            this.environmentName = info.name;
            this.warnings = info.warnings;
            Object.assign(this.timings, {open: info.milliseconds, bake: bake.milliseconds});
            this.stage.setEnvironment(map);
            this.stage.setBake((this.bake = bake));
            this.liveCubes.invalidate();
            await this.provide();
            this.opened();
        });
    }

    private get lacking(): boolean {
        const {shown, needed, state} = this;
        return (shown.includes('phong') && !needed.phong) || (shown.includes('monte-carlo') && needed.rows !== state.rows);
    }
    /// Has the maps computed that the modes on the screen need and that do not exist yet.
    private async provide(): Promise<void> {
        const {shown, state, light} = this;
        if (shown.includes('phong') && !this.needed.phong) {
            this.needed.phong = true;
            const chain = await this.baker.phong(state.size);
            if (light !== this.light) return;
            this.phongLevels = chain.levels.length;
            this.stage.setPhong(chain);
            for (const listener of this.phongListeners) listener();
        }
        if (shown.includes('monte-carlo') && this.needed.rows !== state.rows) {
            this.needed.rows = state.rows;
            const tables = await this.baker.tables(state.rows);
            if (light === this.light) this.stage.setTables(tables);
        }
    }

    private react(changed: Set<keyof State>): void {
        const {state} = this, make = builtInModels[state.model];
        if (changed.has('model') && make && state.model !== this.model.name) this.showModel(make());
        if (changed.has('environment') && state.environment !== this.environmentName) this.source = builtIn(state.environment);
        if (changed.has('projection') && this.refused) void this.useLight(this.refused.name, this.refused.source);
        else if (changed.has('environment') || changed.has('furnace') || changed.has('size') || changed.has('projection')) void this.relight();
        else if (this.bake && this.lacking) void this.work('filtering the environment', () => this.provide());
        if ([...changed].some(key => seenByObjects.has(key))) this.liveCubes.invalidate();
        if (changed.has('live') && !state.live) this.liveCubes.clear();
        const onlyShown = new Set<keyof State>(['exposure', 'tonemap', 'hdr', 'peak', 'divider', 'panel', 'view', 'other']);
        // The rims of the balls have the brightness of the screen.
        if ([...changed].some(key => !onlyShown.has(key)) || (changed.has('exposure') && state.probeBalls)) {
            this.stage.restart();
            this.resolution.move(performance.now());
            this.follow();
        } else if (changed.has('other')) this.stage.panes[1].count = 0;
        this.redraw();
    }

    /// Places a model that moves where it is now.
    private move(): void {
        const {motion} = this.state;
        if (!motion && this.movingSince === null) return;
        const now = performance.now();
        this.movingSince = motion ? (this.movingSince ?? now) : null;
        moveModel(this.model, this.movingSince === null ? null : (now - this.movingSince) / 1000);
        this.stage.placed();
        this.resolution.move(now);
        this.liveCubes.invalidate();
    }
    private lookAround(): void {
        if (!this.state.live || !this.shown.some(mode => (mode === 'split-sum' || mode === 'stretched') && this.stage.probes.purposeOf(mode) === mode)) return;
        void this.liveCubes.step().then(changed => {
            if (!changed) return;
            if (!this.state.motion) this.stage.restart();
            this.redraw();
        }, error => this.events.failed((error as Error).message));
    }

    /// Runs work that takes a while. Whether it went well.
    private async work(what: string, task: () => Promise<void>): Promise<boolean> {
        const well = await this.jobs.run(what, task);
        this.redraw();
        return well;
    }

    /// For tests: a pane when it has averaged this many frames, in base64.
    paneAt(frames: number, index: number): Promise<string> {
        if (this.stage.panes[index]!.count >= frames) this.stage.restart();
        this.redraw();
        return new Promise(resolve => this.waiting.push({frames, index, resolve}));
    }

    private frame(): void {
        this.scheduled = false;
        if (!this.bake || this.stage.lost) return;
        const {state, stage} = this;
        if (!stage.ready(this.shown)) return void setTimeout(() => this.redraw(), k_pause_ms);
        stage.apply(state);
        this.move();
        let unfinished = state.motion;
        this.shown.forEach((mode, k) => {
            const pane = stage.panes[k]!, limit = mode === 'monte-carlo' ? k_noisy_frames : k_frames;
            if (pane.count < limit) stage.advance(pane, mode);
            unfinished ||= pane.count < limit;
        });
        this.lookAround();
        this.events.drawn();
        stage.show(state);
        this.waiting = this.waiting.filter(({frames, index, resolve}) => stage.panes[index]!.count !== frames || void resolve(readPane(stage, index)));
        if (unfinished) this.resolution.frame(performance.now(), this.drawnScale);
        else this.resolution.pause();
        if (this.follow() || unfinished) this.redraw();
    }
}
