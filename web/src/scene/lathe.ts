// Surfaces of revolution about the y axis, and the built-in scenes made of them (src/scene/built_in_scenes.cpp).

import * as THREE from 'three';

/// A point of a profile, from the bottom up, and the normal there: radius and height each.
type ProfilePoint = [radius: number, height: number, normalRadius: number, normalHeight: number];

export function arc(centreHeight: number, radius: number, from: number, to: number, steps: number, centreRadius = 0): ProfilePoint[] {
    return Array.from({length: steps + 1}, (_, i) => {
        const angle = from + ((to - from) * i) / steps;
        const c = Math.abs(Math.abs(angle) - Math.PI / 2) < 1e-9 ? 0 : Math.cos(angle), s = Math.sin(angle);
        return [centreRadius + radius * c, centreHeight + radius * s, c, s];
    });
}

export function line(r0: number, h0: number, r1: number, h1: number): ProfilePoint[] {
    const length = Math.hypot(r1 - r0, h1 - h0), nr = (h1 - h0) / length, nh = (r0 - r1) / length;
    return [[r0, h0, nr, nh], [r1, h1, nr, nh]];
}

/// The surface of several profiles, each smooth in itself; u runs round the axis from +z by +x, v from top to bottom.
export function lathe(profiles: ProfilePoint[][], segments: number): THREE.BufferGeometry {
    const positions: number[] = [], normals: number[] = [], uvs: number[] = [], indices: number[] = [];
    for (const profile of profiles) {
        const base = positions.length / 3;
        profile.forEach(([radius, height, nr, nh], j) => {
            for (let i = 0; i <= segments; ++i) {
                const angle = (2 * Math.PI * (i % segments)) / segments, s = Math.sin(angle), c = Math.cos(angle);
                positions.push(radius * s, height, radius * c);
                normals.push(nr * s, nh, nr * c);
                uvs.push(i / segments, 1 - j / (profile.length - 1));
            }
        });
        for (let j = 0; j + 1 < profile.length; ++j)
            for (let i = 0; i < segments; ++i) {
                const a = base + j * (segments + 1) + i, b = a + 1, c = a + segments + 2, d = a + segments + 1;
                if (profile[j]![0] > 0) indices.push(a, b, c);
                if (profile[j + 1]![0] > 0) indices.push(a, c, d);
            }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normals, 3));
    geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs, 2));
    geometry.setIndex(indices);
    return geometry;
}

export const sphere = (segments: number): THREE.BufferGeometry =>
    lathe([arc(0, 1, -Math.PI / 2, Math.PI / 2, segments / 2)], segments);
