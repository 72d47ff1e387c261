// A camera that shows the whole of a model.

import * as THREE from 'three';
import type {Model, View} from './built_in';

/// The view for a picture of this shape: the model's own, or one from the front, a little from the right and from above, as
/// `domelight render` has it.
/// margin: how much larger than the model the picture is, where the model has no view of its own.
export function viewOf(model: Model, aspect: number, margin = 1.05): View {
    if (model.view) {
        const {view} = model;
        const tall = Math.max(1, view.aspect / aspect);
        return {...view, fovDeg: degrees(2 * Math.atan(Math.tan(radians(view.fovDeg) / 2) * tall))};
    }
    const box = new THREE.Box3().setFromObject(model.root, true);
    const middle = box.getCenter(new THREE.Vector3()), back = new THREE.Vector3(0.25, 0.2, 1).normalize();
    const fovDeg = 35, tanY = Math.tan(radians(fovDeg) / 2) / margin;
    const distance = Math.max(1e-6, framingDistance(box, middle, back, tanY * aspect, tanY));
    return {eye: middle.clone().addScaledVector(back, distance).toArray(), target: middle.toArray(), fovDeg, aspect};
}

/// How far from the middle of a box a camera that looks along -back must stand to see all of it.
function framingDistance(box: THREE.Box3, middle: THREE.Vector3, back: THREE.Vector3, tanX: number, tanY: number): number {
    const right = new THREE.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right), p = new THREE.Vector3();
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
        p.set(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z).sub(middle);
        distance = Math.max(distance, p.dot(back) + Math.max(Math.abs(p.dot(right)) / tanX, Math.abs(p.dot(up)) / tanY));
    }
    return distance;
}

export const degrees = (radians: number): number => (radians * 180) / Math.PI;
export const radians = (degrees: number): number => (degrees * Math.PI) / 180;
