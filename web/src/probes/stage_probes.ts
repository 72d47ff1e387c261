// The set of probes of a stage: its textures, and the balls that show where they stand.

import type * as THREE from 'three';
import type {Purpose} from '../render/programs';
import {probeModes} from '../render/programs';
import type {Uniforms} from '../render/surfaces';
import type {Mode, State} from '../state';
import {ballsOf} from './balls';
import type {ProbeSet} from './load';
import {probeUniforms, setProbeUniforms} from './textures';

export class StageProbes {
    readonly uniforms: Uniforms = probeUniforms();
    set: ProbeSet | null = null;
    private wanted = false;
    private balls?: THREE.Mesh;
    private readonly ballWhite = {value: 1};

    /// shared: the uniforms of the stage, among which are those of this set.
    use(set: ProbeSet, renderer: THREE.WebGLRenderer, scene: THREE.Scene, shared: Uniforms): void {
        const gl = renderer.getContext() as WebGL2RenderingContext;
        setProbeUniforms(this.uniforms, set, gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number);
        this.set = set;
        if (this.balls) {
            scene.remove(this.balls);
            this.balls.geometry.dispose();
            (this.balls.material as THREE.Material).dispose();
        }
        this.balls = ballsOf(set.record.probes, {...shared, u_ball_white: this.ballWhite});
        scene.add(this.balls);
    }
    showBalls(shown: boolean): void {
        if (this.balls) this.balls.visible = shown;
    }
    /// What the user has chosen, as uniforms.
    apply(state: State): void {
        const u = this.uniforms;
        this.wanted = state.probes;
        this.ballWhite.value = 2 ** -state.exposure;
        this.showBalls(state.probeBalls);
        u.u_probe_most!.value = Math.min(8, Math.max(1, Math.round(state.probeBlend)));
        u.u_probe_parallax!.value = state.probeParallax;
        u.u_probe_use_visibility!.value = state.probeVisibility;
        u.u_probe_use_all!.value = !state.probeVisibility || !this.set?.record.probes.some(({valid}) => valid);
    }
    /// What a mode is drawn with.
    purposeOf(mode: Mode): Purpose {
        const lit = this.set && this.wanted ? probeModes.find(name => name === mode) : undefined;
        return lit ? `${lit} by probes` : mode;
    }
}
