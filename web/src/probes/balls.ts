// Small balls where the probes stand.

import * as THREE from 'three';
import {probeBallProgram} from '../render/programs';
import type {Uniforms} from '../render/surfaces';
import type {Probe} from './record';

export const kindOf = ({valid, moved}: Probe): number => (!valid ? 2 : moved ? 1 : 0);

/// uniforms: of the set, and of the camera.
export function ballsOf(probes: Probe[], uniforms: Uniforms): THREE.Mesh {
    const geometry = new THREE.InstancedBufferGeometry(), ball = new THREE.SphereGeometry(1, 24, 16);
    geometry.setIndex(ball.index);
    geometry.setAttribute('position', ball.getAttribute('position'));
    geometry.setAttribute('centre', new THREE.InstancedBufferAttribute(Float32Array.from(probes.flatMap(({position}) => position)), 3));
    geometry.setAttribute('kind', new THREE.InstancedBufferAttribute(Float32Array.from(probes, kindOf), 1));
    geometry.instanceCount = probes.length;
    const material = new THREE.RawShaderMaterial({...probeBallProgram, glslVersion: THREE.GLSL3, uniforms: {...uniforms, u_ball_radius: {value: radiusFor(probes)}}});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
}

/// A twelfth of the distance at which half of the probes have a neighbour.
function radiusFor(probes: Probe[]): number {
    const nearest = probes.map(({position: a}, i) => Math.min(...probes.map(({position: b}, k) => (i === k ? Infinity : Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])))));
    const middle = nearest.sort((a, b) => a - b)[probes.length >> 1]!;
    return Number.isFinite(middle) && middle > 0 ? middle / 12 : 0.1;
}
