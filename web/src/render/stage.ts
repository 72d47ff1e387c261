// The scene, the light and the camera, drawn by any mode into panes and from there to the screen.

import * as THREE from 'three';
import stretchedFit from '../../../src/render/shading/stretched_fit.cpp?raw';
import {matchingRoughness} from '../bake/chain';
import type {Bake, BrdfTable, Chain, EnvironmentInfo, Tables} from '../bake/types';
import {radians} from '../scene/framing';
import {backgrounds, lookups, strategies, tables, tonemaps, type Mode, type State} from '../state';
import {LookupMaps} from './lookup_maps';
import {brdfTexture, chainTexture, cubeTexture, latlongTexture, stretchedTexture, tableTexture} from './maps';
import {Pane} from './pane';
import {Pass, triangle} from './passes';
import {backgroundProgram, presentProgram} from './programs';
import {litMeshes, type LitMesh, type Uniforms} from './surfaces';

const uniform = <T>(value: T) => ({value});

export class Stage {
    readonly renderer: THREE.WebGLRenderer;
    readonly camera = new THREE.PerspectiveCamera();
    readonly panes: [Pane, Pane];
    readonly uniforms: Uniforms = {
        u_eye: uniform(new THREE.Vector3()), u_turn: uniform(new THREE.Matrix3()), u_environment: uniform(new THREE.Matrix3()),
        u_specular: uniform(null), u_irradiance: uniform(null), u_brdf: uniform(null), u_last_level: uniform(1),
        u_sh: uniform(Array.from({length: 9}, () => new THREE.Vector3())), u_latlong: uniform(null),
        u_multiple_scattering: uniform(false), u_harmonics: uniform(false), u_bent_lookup: uniform(false), u_fresnel_weight: uniform(false),
        u_occlusion: uniform(true), u_ior_outside: uniform(1), u_lookup: uniform(0), u_lookup_map: uniform(null), u_lookup_back: uniform(null),
        u_phong: uniform(null), u_phong_roughness: uniform(new Float32Array(16)), u_phong_levels: uniform(1), u_exponent: uniform(-1),
        u_stretched_fit: uniform(stretchedTexture(stretchedFit)),
        u_envmap_frame: uniform(new THREE.Matrix3()), u_envmap: uniform(null), u_row_averages: uniform(null), u_total_average: uniform(1),
        u_columns: uniform(null), u_rows: uniform(null), u_strategy: uniform(0), u_tables: uniform(0), u_samples: uniform(1), u_frame: uniform(0),
        u_override: uniform(false), u_override_color: uniform(new THREE.Color()), u_override_metalness: uniform(1), u_override_roughness: uniform(0),
        u_background: uniform(0), u_background_color: uniform(new THREE.Color(1, 1, 1)), u_background_roughness: uniform(0.35),
        u_unproject: uniform(new THREE.Matrix4()),
    };
    private readonly scene = new THREE.Scene();
    private readonly present: Pass;
    private readonly lookups: LookupMaps;
    private meshes: LitMesh[] = [];
    private model?: THREE.Object3D;

    constructor(canvas: HTMLCanvasElement) {
        this.renderer = new THREE.WebGLRenderer({canvas, antialias: false, depth: false, stencil: false, alpha: false});
        this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // the shaders write what the screen shows
        this.renderer.autoClear = true;
        this.panes = [new Pane(this.renderer), new Pane(this.renderer)];
        this.lookups = new LookupMaps(this.renderer, this.uniforms.u_latlong!);
        const sky = triangle(new THREE.RawShaderMaterial({
            ...backgroundProgram, glslVersion: THREE.GLSL3, uniforms: this.uniforms, depthWrite: false, depthFunc: THREE.LessEqualDepth,
        }));
        sky.renderOrder = -1;
        this.scene.add(sky);
        this.scene.matrixWorldAutoUpdate = true;
        this.present = new Pass(presentProgram, {
            u_left: uniform(null), u_right: uniform(null), u_map: uniform(null), u_divider: uniform(1), u_view: uniform(0),
            u_tonemap: uniform(0), u_exposure: uniform(1),
        });
    }

    resize(width: number, height: number): void {
        this.renderer.setSize(width, height, false);
        for (const pane of this.panes) pane.resize(width, height);
    }

    setModel(root: THREE.Object3D): void {
        for (const mesh of this.meshes) mesh.dispose();
        if (this.model) this.scene.remove(this.model);
        this.model = root;
        this.meshes = litMeshes(root, this.uniforms);
        this.scene.add(root);
        this.restart();
    }

    setEnvironment(info: EnvironmentInfo): void {
        this.replace('u_latlong', latlongTexture(info));
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
        u.u_exponent!.value = state.override ? state.exponent : -1;
        u.u_ior_outside!.value = state.iorOutside;
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

    restart(): void {
        for (const pane of this.panes) pane.count = 0;
    }

    /// One more frame of a pane.
    advance(pane: Pane, mode: Mode): void {
        this.camera.aspect = pane.width / pane.height;
        this.camera.updateProjectionMatrix();
        this.camera.updateMatrixWorld();
        for (const mesh of this.meshes) mesh.use(mode);
        this.uniforms.u_frame!.value = pane.count;
        (this.uniforms.u_eye!.value as THREE.Vector3).copy(this.camera.position);
        pane.advance(this.camera, mode === 'monte-carlo', () => {
            this.camera.updateProjectionMatrix();
            const view = new THREE.Matrix4().extractRotation(this.camera.matrixWorld);
            (this.uniforms.u_unproject!.value as THREE.Matrix4).copy(view.multiply(this.camera.projectionMatrixInverse));
            this.renderer.clear();
            this.renderer.render(this.scene, this.camera);
        });
    }

    show(state: State): void {
        const u = this.present.uniforms;
        u.u_left!.value = this.panes[0].target.texture;
        u.u_right!.value = this.panes[1].target.texture;
        u.u_divider!.value = state.view === 'split' ? state.divider : 2;
        u.u_tonemap!.value = tonemaps.indexOf(state.tonemap);
        u.u_exposure!.value = 2 ** state.exposure;
        this.present.run(this.renderer, null);
    }
}
