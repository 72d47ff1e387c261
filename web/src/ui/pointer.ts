// The pointer over the picture: drag to orbit, shift and drag to turn the light, the right button or two fingers to move, the wheel or a
// pinch to come nearer.

import * as THREE from 'three';
import {radians} from '../scene/framing';
import type {Store} from '../state';

export function orbit(store: Store, rightward: number, upward: number): void {
    const {eye, target} = store.state, offset = new THREE.Vector3(...eye).sub(new THREE.Vector3(...target));
    const place = new THREE.Spherical().setFromVector3(offset);
    place.theta -= rightward;
    place.phi = Math.min(Math.PI - 0.02, Math.max(0.02, place.phi - upward));
    store.set({eye: offset.setFromSpherical(place).add(new THREE.Vector3(...target)).toArray()});
}

export function turnLight(store: Store, byDeg: number): void {
    store.set({turn: ((((store.state.turn + byDeg + 180) % 360) + 360) % 360) - 180});
}

/// Moves eye and target across the picture, by parts of its height.
function pan(store: Store, right: number, up: number): void {
    const {eye, target, fov} = store.state, e = new THREE.Vector3(...eye), t = new THREE.Vector3(...target);
    const forward = t.clone().sub(e), scale = 2 * forward.length() * Math.tan(radians(fov) / 2);
    const across = forward.clone().cross(new THREE.Vector3(0, 1, 0)).normalize(), above = across.clone().cross(forward).normalize();
    const move = across.multiplyScalar(-right * scale).add(above.multiplyScalar(up * scale));
    store.set({eye: e.add(move).toArray(), target: t.add(move).toArray()});
}

export function bindPointer(canvas: HTMLCanvasElement, store: Store, zoom: (factor: number) => void, hover: (x: number, y: number) => void, leave: () => void): void {
    const pointers = new Map<number, {x: number; y: number}>();
    canvas.addEventListener('pointerdown', event => {
        canvas.setPointerCapture(event.pointerId);
        pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    for (const end of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(end, event => pointers.delete(event.pointerId));
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('pointermove', event => {
        const last = pointers.get(event.pointerId), height = canvas.clientHeight;
        hover(event.clientX, event.clientY);
        if (!last) return;
        const dx = event.clientX - last.x, dy = event.clientY - last.y;
        if (pointers.size === 2) {
            const other = [...pointers].find(([id]) => id !== event.pointerId)![1];
            const before = Math.hypot(last.x - other.x, last.y - other.y), after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
            if (after > 0) zoom(before / after);
            pan(store, dx / 2 / height, dy / 2 / height);
        } else if (event.shiftKey) turnLight(store, (-dx / height) * 180);
        else if (event.buttons & 6 || event.ctrlKey) pan(store, dx / height, dy / height);
        else orbit(store, (dx / height) * Math.PI, (dy / height) * Math.PI);
        Object.assign(last, {x: event.clientX, y: event.clientY});
    });
    canvas.addEventListener('pointerleave', leave);
    canvas.addEventListener('pointerover', event => hover(event.clientX, event.clientY));  // after a change of the page also without a move
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        zoom(Math.exp(Math.min(0.5, Math.max(-0.5, event.deltaY * 0.0012))));
    }, {passive: false});
}
