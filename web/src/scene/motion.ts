// A model that moves, so that what objects see of each other changes: the balls of the built-in scenes to and fro, other models about the vertical axis.

import type * as THREE from 'three';
import type {Model} from './built_in';

const k_way = 0.8, k_turns_per_second = 0.05;

/// Places a model as it is after some seconds; null: at rest.
export function moveModel({root, view}: Model, seconds: number | null): void {
    if (!view) {
        root.rotation.y = 2 * Math.PI * k_turns_per_second * (seconds ?? 0);
        return;
    }
    root.children.forEach((child: THREE.Object3D, k) => {
        const rest: number = (child.userData.restZ ??= child.position.z);
        child.position.z = rest + (seconds === null ? 0 : k_way * (Math.sin(1.2 * seconds + 2.4 * k) - Math.sin(2.4 * k)));
    });
}
