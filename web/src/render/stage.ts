// The scene, the light and the camera, drawn by any mode into panes and from there to the screen.

import * as THREE from 'three';
import {matchingRoughness} from '../bake/chain';
import type {Bake, BrdfTable, Chain, EnvironmentInfo, Latlong, Tables} from '../bake/types';
import type {ProbeSet} from '../probes/load';
import {StageProbes} from '../probes/stage_probes';
import {radians} from '../scene/framing';
import {k_most_lights, lightVectors} from '../scene/lights';
import {backgrounds, isPicture, lookups, strategies, tables, tonemaps, type Mode, type State} from '../state';
import {Backlog} from './backlog';
import {LookupMaps} from './lookup_maps';
import {brdfTexture, chainTexture, cubeTexture, latlongTexture, tableTexture} from './maps';
import {Pane} from './pane';
import {compile, Pass, triangle} from './passes';
import type {HdrScreen} from './hdr_screen';
import {backgroundProgram, presentExtendedProgram, presentProgram, type Purpose} from './programs';
import {litMeshes, type LitMesh, type Uniforms} from './surfaces';
import {uploadInSlices} from './upload';

/// Where the faces +X -X +Y -Y +Z -Z look, and what is up in them.
const cubeFaces: [THREE.Vector3Tuple, THREE.Vector3Tuple][] = [
    [[1, 0, 0], [0, 1, 0]], [[-1, 0, 0], [0, 1, 0]], [[0, 1, 0], [0, 0, -1]], [[0, -1, 0], [0, 0, 1]], [[0, 0, 1], [0, 1, 0]], [[0, 0, -1], [0, 1, 0]],
];

const uniform = <T>(value: T) => ({value});

export class Stage {
    readonly renderer: THREE.WebGLRenderer;
    readonly camera = new THREE.PerspectiveCamera();
    readonly panes: [Pane, Pane];
    readonly backlog: Backlog;
    /// Pixels of the picture, and those of them that the panel covers: the model stands in the middle of the rest.
    private size = {width: 1, height: 1};
    inset = {right: 0, bottom: 0};
    readonly probes = new StageProbes();
    readonly uniforms: Uniforms = {
        ...this.probes.uniforms,
        u_eye: uniform(new THREE.Vector3()), u_turn: uniform(new THREE.Matrix3()), u_environment: uniform(new THREE.Matrix3()),
        u_specular: uniform(null), u_irradiance: uniform(null), u_brdf: uniform(null), u_last_level: uniform(1),
        u_sh: uniform(Array.from({length: 9}, () => new THREE.Vector3())), u_latlong: uniform(null),
        u_multiple_scattering: uniform(false), u_harmonics: uniform(false), u_bent_lookup: uniform(false), u_fresnel_weight: uniform(false),
        u_occlusion: uniform(true), u_ior_outside: uniform(1), u_ior_inside: uniform(-1), u_lookup: uniform(0), u_lookup_map: uniform(null), u_lookup_back: uniform(null),
        u_phong: uniform(null), u_phong_roughness: uniform(new Float32Array(16)), u_phong_levels: uniform(1), u_exponent: uniform(-1),
        u_envmap_frame: uniform(new THREE.Matrix3()), u_envmap: uniform(null), u_row_averages: uniform(null), u_total_average: uniform(1),
        u_columns: uniform(null), u_rows: uniform(null), u_strategy: uniform(0), u_tables: uniform(0), u_samples: uniform(1), u_frame: uniform(0),
        u_override: uniform(false), u_override_color: uniform(new THREE.Color()), u_override_metalness: uniform(1), u_override_roughness: uniform(0),
        u_background: uniform(0), u_background_color: uniform(new THREE.Color(1, 1, 1)), u_background_roughness: uniform(0.35),
        u_unproject: uniform(new THREE.Matrix4()), u_light_count: uniform(0), u_lights: uniform(Array.from({length: 4 * k_most_lights}, () => new THREE.Vector4())),
    };
    private readonly scene = new THREE.Scene();
    readonly present: Pass;
    /// On a screen that shows more than white; otherwise null.
    private extended: {screen: HdrScreen; pass: Pass} | null = null;
    private readonly lookups: LookupMaps;
    private meshes: LitMesh[] = [];
    private model?: THREE.Object3D;
    private readonly pictures: Partial<Record<'picture' | 'truth', THREE.DataTexture>> = {};
    /// How often they have changed: a comparison with an earlier one is out of date.
    pictureChanges = 0;
    private readonly sky: THREE.Mesh;
    /// What the model can be drawn for without waiting.
    private readonly prepared = new Set<Purpose>();
    private preparing = false;
    private readonly cubeCamera = new THREE.PerspectiveCamera(90, 1);
    private readonly tiny = new THREE.WebGLRenderTarget(1, 1);
    private uploads = 0;
    /// Of the model.
    lights = 0;

    constructor(canvas: HTMLCanvasElement) {
        this.renderer = new THREE.WebGLRenderer({canvas, antialias: false, depth: false, stencil: false, alpha: false});
        this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shaders write what the screen shows
        this.renderer.autoClear = true;
        this.backlog = new Backlog(this.renderer);
        this.panes = [new Pane(this.renderer), new Pane(this.renderer)];
        this.lookups = new LookupMaps(this.renderer, this.uniforms.u_latlong!);
        this.sky = triangle(new THREE.RawShaderMaterial({
            ...backgroundProgram, glslVersion: THREE.GLSL3, uniforms: this.uniforms, depthWrite: false, depthFunc: THREE.LessEqualDepth,
        }));
        this.sky.renderOrder = -1;
        this.scene.add(this.sky);
        this.scene.matrixWorldAutoUpdate = true;
        this.present = new Pass(presentProgram, {
            u_left: uniform(null), u_right: uniform(null), u_map: uniform(null), u_divider: uniform(1), u_view: uniform(0),
            u_tonemap: uniform(0), u_exposure: uniform(1),
        });
    }

    /// Takes effect with the next frame.
    resize(width: number, height: number, inset: {right: number; bottom: number}): void {
        // Another view of the model: what was drawn does not belong to it.
        if (this.inset.right !== inset.right || this.inset.bottom !== inset.bottom) this.restart();
        this.size = {width, height};
        this.inset = inset;
    }
    private fit(): void {
        const {width, height} = this.size, drawn = this.renderer.domElement, high = this.extended ? 2 * height : height;
        if (drawn.width !== width || drawn.height !== high) this.renderer.setSize(width, high, false);
        if (this.panes[0].width !== width || this.panes[0].height !== height) for (const pane of this.panes) pane.resize(width, height);
    }
    /// What the picture is shown by, besides the canvas of WebGL2; null: by that alone.
    useScreen(screen: HdrScreen | null): void {
        this.extended = screen && {screen, pass: new Pass(presentExtendedProgram, {...this.present.uniforms, u_peak: uniform(4)})};
        this.prepared.clear();
    }

    /// Whether a frame can be drawn now without waiting for the graphics card: it has done the last one, and has the textures of the model and
    /// the compiled shaders of these modes, which are otherwise begun here.
    ready(modes: Mode[]): boolean {
        const purposes = modes.map(mode => this.probes.purposeOf(mode));
        if (!this.preparing && purposes.some(purpose => !this.prepared.has(purpose))) void this.prepare(purposes);
        // A picture becomes no better while the next environment is on its way.
        if (this.preparing || (this.uploads > 0 && this.panes[0].count > 0) || !this.backlog.done) return false;
        this.fit();
        return true;
    }
    private async prepare(purposes: Purpose[]): Promise<void> {
        this.preparing = true;
        const {meshes, renderer, backlog} = this, {add} = this.panes[0];
        for (const texture of new Set(meshes.flatMap(mesh => mesh.textures))) {
            await backlog.emptied();
            renderer.initTexture(texture);
            backlog.mark();
        }
        await Promise.all([add, ...this.presents].map(pass => pass.compile(renderer)));
        for (const purpose of purposes) {
            for (const mesh of meshes) mesh.use(purpose);
            await compile(renderer, this.scene, this.camera);
            await backlog.emptied();
            if (meshes === this.meshes) this.firstUse(purpose);
        }
        this.preparing = false;
    }
    /// three.js asks for the uniforms of a shader when it is first drawn with, and waits for all that was given to the card before: little, here.
    private firstUse(purpose: Purpose): void {
        for (const mesh of this.meshes) mesh.use(purpose);
        this.renderer.setRenderTarget(this.tiny);
        this.renderer.render(this.scene, this.camera);
        for (const pass of [this.panes[0].add, ...this.presents]) pass.run(this.renderer, this.tiny);
        this.backlog.mark();
        this.prepared.add(purpose);
    }

    setModel(root: THREE.Object3D): void {
        for (const mesh of this.meshes) mesh.dispose(root !== this.model);
        if (this.model) this.scene.remove(this.model);
        this.model = root;
        this.meshes = litMeshes(root, this.uniforms);
        this.scene.add(root);
        this.placeLights();
        this.prepared.clear();
        this.restart();
    }

    /// The map of an environment as a texture that the graphics card has. Not in use before setEnvironment().
    async upload(info: EnvironmentInfo): Promise<THREE.DataTexture> {
        const texture = latlongTexture(info);
        ++this.uploads;
        await uploadInSlices(this.renderer, texture, this.backlog).finally(() => --this.uploads);
        return texture;
    }
    setEnvironment(map: THREE.DataTexture): void {
        this.replace('u_latlong', map);
        this.lookups.forget();
    }
    setBake(bake: Bake): void {
        this.replace('u_specular', chainTexture(bake.specular));
        this.replace('u_irradiance', cubeTexture([bake.irradiance]));
        this.uniforms.u_last_level!.value = bake.specular.levels.length - 1;
        (this.uniforms.u_sh!.value as THREE.Vector3[]).forEach((v, k) => v.fromArray(bake.sh, 3 * k));
        this.restart();
    }
    setPhong(chain: Chain): void {
        this.replace('u_phong', chainTexture(chain));
        (this.uniforms.u_phong_roughness!.value as Float32Array).set(chain.parameters.map(matchingRoughness));
        this.uniforms.u_phong_levels!.value = chain.levels.length;
        this.restart();
    }
    setTables({width, height, texels, rowAverages, totalAverage, columns, rows}: Tables): void {
        this.replace('u_envmap', tableTexture(texels, width, height));
        this.replace('u_row_averages', tableTexture(rowAverages, 1, height));
        this.replace('u_columns', tableTexture(columns, width, height));
        this.replace('u_rows', tableTexture(rows, 1, height));
        this.uniforms.u_total_average!.value = totalAverage;
        this.restart();
    }
    /// Throws a sentence where the graphics card cannot take the set.
    setProbes(set: ProbeSet): void {
        this.probes.use(set, this.renderer, this.scene, this.uniforms);
        this.restart();
    }
    setBrdf(table: BrdfTable): void {
        this.replace('u_brdf', brdfTexture(table));
    }
    private replace(name: string, texture: THREE.Texture): void {
        (this.uniforms[name]!.value as THREE.Texture | null)?.dispose();
        this.uniforms[name]!.value = texture;
    }

    /// What the user has chosen, as uniforms.
    apply(state: State): void {
        const u = this.uniforms;
        this.probes.apply(state);
        u.u_multiple_scattering!.value = state.multipleScattering;
        u.u_harmonics!.value = state.irradiance === 'sh';
        u.u_bent_lookup!.value = state.bentLookup;
        u.u_fresnel_weight!.value = state.diffuseWeight === 'fresnel';
        u.u_occlusion!.value = state.occlusion;
        u.u_background!.value = backgrounds.indexOf(state.background);
        u.u_background_roughness!.value = state.blur;
        const turn = radians(state.turn), c = Math.cos(turn), s = Math.sin(turn);
        // Turns the light about +Y, from +X towards +Z: this is the inverse turn, of the directions.
        const world = u.u_turn!.value as THREE.Matrix3;
        world.set(c, 0, s, 0, 1, 0, -s, 0, c);
        (u.u_environment!.value as THREE.Matrix3).copy(world);
        // The frame of docs/shaders/spherical_envmap.glsl, for files of the convention `default` in a world with +Y up.
        (u.u_envmap_frame!.value as THREE.Matrix3).set(-1, 0, 0, 0, 0, 1, 0, 1, 0).multiply(world);
        u.u_override!.value = state.override;
        (u.u_override_color!.value as THREE.Color).setStyle(state.color);  // sRGB, as on the screen, to linear
        u.u_override_metalness!.value = state.metalness;
        u.u_override_roughness!.value = state.roughness;
        u.u_exponent!.value = state.override ? 2 ** state.exponentLog2 : -1;
        u.u_ior_outside!.value = state.iorOutside;
        u.u_ior_inside!.value = state.iorOverride ? state.ior : -1;
        u.u_light_count!.value = state.lights ? this.lights : 0;
        u.u_strategy!.value = strategies.indexOf(state.strategy);
        u.u_tables!.value = tables.indexOf(state.tables);
        u.u_samples!.value = state.samples;
        u.u_lookup!.value = lookups.indexOf(state.lookup);
        const {front, back} = this.lookups.get(state.lookup, state.lookupSize);
        u.u_lookup_map!.value = front;
        u.u_lookup_back!.value = back;
        this.camera.position.fromArray(state.eye);
        this.camera.up.set(0, 1, 0);
        this.camera.lookAt(...state.target);
        this.camera.fov = state.fov;
        const distance = Math.hypot(...state.eye.map((v, k) => v - state.target[k]!));
        this.camera.near = distance / 100;
        this.camera.far = distance * 100;
    }

    get lost(): boolean {
        return this.renderer.getContext().isContextLost();
    }
    /// The graphics card is back: three.js uploads what it is given; what was drawn has to be drawn again.
    restore(): void {
        this.prepared.clear();
        this.backlog.forget();
        this.lookups.forget();
        this.restart();
    }
    restart(): void {
        for (const pane of this.panes) pane.count = 0;
    }

    /// Width over height of what the panel does not cover.
    get freeAspect(): number {
        const {size: {width, height}, inset: {right, bottom}} = this;
        return Math.max(1, width - right) / Math.max(1, height - bottom);
    }
    /// Points the camera at a part of the picture, from pixel (x, y) on.
    look(x: number, y: number, width: number, height: number): void {
        const {width: all, height: high} = this.panes[0], {right, bottom} = this.inset;
        // The field of view belongs to what is free; the picture goes on below the panel.
        this.camera.aspect = this.freeAspect;
        this.camera.setViewOffset(Math.max(1, all - right), Math.max(1, high - bottom), x, y, width, height);
        this.camera.updateProjectionMatrix();
    }

    /// The point of the model's surface that is seen at a point of the picture, 0 to 1 from the upper left corner; null beside the model.
    surfaceAt(x: number, y: number): THREE.Vector3 | null {
        const {width, height} = this.panes[0], ray = new THREE.Raycaster();
        this.look(0, 0, width, height);
        this.camera.updateMatrixWorld();
        ray.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), this.camera);
        return ray.intersectObjects(this.meshes.map(({mesh}) => mesh), false)[0]?.point ?? null;
    }
    /// One more frame of a pane.
    advance(pane: Pane, mode: Mode): void {
        this.camera.updateMatrixWorld();
        for (const mesh of this.meshes) mesh.use(this.probes.purposeOf(mode));
        this.uniforms.u_frame!.value = pane.count;
        (this.uniforms.u_eye!.value as THREE.Vector3).copy(this.camera.position);
        pane.advance((x, y) => this.look(x, y, pane.width, pane.height), mode === 'monte-carlo', () => {
            const view = new THREE.Matrix4().extractRotation(this.camera.matrixWorld);
            (this.uniforms.u_unproject!.value as THREE.Matrix4).copy(view.multiply(this.camera.projectionMatrixInverse));
            this.renderer.clear();
            this.renderer.render(this.scene, this.camera);
        });
    }

    private placeLights(): void {
        const vectors = this.model ? lightVectors(this.model) : [], all = this.uniforms.u_lights!.value as THREE.Vector4[];
        vectors.forEach((v, k) => all[k]!.copy(v));
        this.lights = vectors.length / 4;
    }
    get objects(): readonly LitMesh[] {
        return this.meshes;
    }
    /// The model has been moved.
    placed(): void {
        this.model?.updateMatrixWorld(true);
        for (const mesh of this.meshes) mesh.place();
        this.placeLights();
        this.restart();
    }
    /// Draws what is seen of the other objects from the middle of one, by split-sum, over zeros: six faces one above the other, as they lie in the frame of the
    /// environment. In each the rows and the columns are in reverse order.
    drawCube(target: THREE.WebGLRenderTarget, size: number, object: LitMesh): void {
        const {renderer, scene, cubeCamera} = this, centre = object.centre, toWorld = new THREE.Matrix4().setFromMatrix3((this.uniforms.u_turn!.value as THREE.Matrix3).clone().transpose());
        for (const mesh of this.meshes) mesh.use('split-sum');
        this.sky.visible = object.mesh.visible = false;
        this.probes.showBalls(false);
        (this.uniforms.u_eye!.value as THREE.Vector3).copy(centre);
        cubeCamera.near = Math.max(1e-6, 0.05 * object.radius);
        cubeCamera.far = 1e5 * cubeCamera.near;
        cubeCamera.updateProjectionMatrix();
        cubeCamera.position.copy(centre);
        renderer.setClearColor(0, 0);
        target.scissorTest = true;
        cubeFaces.forEach(([forward, up], face) => {
            cubeCamera.up.fromArray(up).applyMatrix4(toWorld);
            cubeCamera.lookAt(new THREE.Vector3().fromArray(forward).applyMatrix4(toWorld).add(centre));
            cubeCamera.updateMatrixWorld();
            target.viewport.set(0, face * size, size, size);
            target.scissor.copy(target.viewport);
            renderer.setRenderTarget(target);
            renderer.clear();
            renderer.render(scene, cubeCamera);
        });
        this.sky.visible = object.mesh.visible = true;
    }

    /// What stands on the right: the second pane, or a picture. Until there is one, it is what stands on the left.
    side(state: State, index: number): THREE.Texture {
        const {other} = state;
        return index === 1 && isPicture(other) ? (this.pictures[other] ?? this.panes[0].target.texture) : this.panes[index]!.target.texture;
    }
    /// Whether there is something to compare with.
    hasOther({other}: State): boolean {
        return !isPicture(other) || this.pictures[other] !== undefined;
    }

    private get presents(): Pass[] {
        return this.extended ? [this.present, this.extended.pass] : [this.present];
    }
    show(state: State): void {
        const u = this.present.uniforms;
        u.u_left!.value = this.side(state, 0);
        u.u_right!.value = this.side(state, 1);
        u.u_divider!.value = state.view === 'split' ? state.divider : state.view === 'other' ? -1 : 2;
        u.u_view!.value = state.view === 'flip' && this.mapped ? 1 : state.view === 'flip' || state.view === 'difference' ? 2 : 0;  // until FLIP is known, the difference
        this.setDisplay(u, state);
        const {extended, renderer: {domElement: {width, height}}} = this;
        if (extended) {
            extended.pass.uniforms.u_peak!.value = state.peak;
            extended.pass.run(this.renderer, null);
            extended.screen.show(width, height / 2);
        } else this.present.run(this.renderer, null);
        this.backlog.mark();
    }
    /// Draws the picture as an ordinary screen shows it into the canvas of WebGL2, where it stays until the next frame.
    showWhite(state: State): void {
        const {extended} = this;
        this.extended = null;
        this.fit();
        this.show(state);
        this.extended = extended;
    }
    setDisplay(u: Uniforms, state: State): void {
        u.u_tonemap!.value = tonemaps.indexOf(state.tonemap);
        u.u_exposure!.value = 2 ** state.exposure;
    }

    /// Draws every surface for another purpose than to be seen: without the background, over zeros.
    drawFor(purpose: Purpose, target: THREE.WebGLRenderTarget): void {
        for (const mesh of this.meshes) mesh.use(purpose);
        this.sky.visible = false;
        this.probes.showBalls(false);
        this.renderer.setRenderTarget(target);
        this.renderer.setClearColor(0, 0);
        this.renderer.clear();
        this.renderer.render(this.scene, this.camera);
        this.sky.visible = true;
    }

    get objectNames(): string[] {
        return this.meshes.map(({mesh}, k) => mesh.name || `object ${k + 1}`);
    }
    /// Whether FLIP is known.
    get mapped(): boolean {
        return this.present.uniforms.u_map!.value !== null;
    }
    /// FLIP in colours, RGBA; null: it is not known.
    setMap(map: {bytes: Uint8Array; width: number; height: number} | null): void {
        const u = this.present.uniforms, texture = map && new THREE.DataTexture(map.bytes, map.width, map.height);
        if (texture) texture.needsUpdate = true;
        u.u_map!.value?.dispose();
        u.u_map!.value = texture;
    }
    /// A picture from a file or of the path tracer, which is compared with what is drawn.
    setPicture(kind: 'picture' | 'truth', picture: Latlong): void {
        this.dropPicture(kind);
        const {width, height, pixels: rgb} = picture, rgba = new Float32Array(4 * width * height);
        for (let y = 0, from = 0; y < height; ++y)
            for (let x = 0, to = 4 * (height - 1 - y) * width; x < width; ++x, from += 3, to += 4) {
                rgba[to] = rgb[from]!;
                rgba[to + 1] = rgb[from + 1]!;
                rgba[to + 2] = rgb[from + 2]!;
            }
        this.pictures[kind] = tableTexture(rgba, width, height);
    }
    dropPicture(kind: 'picture' | 'truth'): void {
        ++this.pictureChanges;
        this.pictures[kind]?.dispose();
        delete this.pictures[kind];
    }
    /// RGB of a picture at a pixel of the pane, from the upper left corner; null where there is none.
    pictureAt(kind: 'picture' | 'truth', x: number, y: number): [number, number, number] | null {
        const image = this.pictures[kind]?.image as {width: number; height: number; data: Float32Array} | undefined, {width, height} = this.panes[0];
        if (!image) return null;
        const at = 4 * ((image.height - 1 - Math.floor((y / height) * image.height)) * image.width + Math.floor((x / width) * image.width));
        return [image.data[at]!, image.data[at + 1]!, image.data[at + 2]!];
    }
}
