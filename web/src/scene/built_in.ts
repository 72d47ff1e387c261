// The built-in scenes: `spheres`, `ball` and `furnace` are those of `domelight render`.

import * as THREE from 'three';
import {arc, lathe, line, sphere} from './lathe';

export interface View {
    eye: [number, number, number];
    target: [number, number, number];
    fovDeg: number;
    /// Width over height of the picture that the field of view was chosen for.
    aspect: number;
}
export interface Model {
    name: string;
    root: THREE.Object3D;
    view?: View;
    /// Names of the material variants (KHR_materials_variants).
    variants: string[];
    /// Sentences on what of its file is not drawn.
    notes?: string[];
    /// Gives every mesh the material of a variant; null: the file's own.
    useVariant?: (index: number | null) => Promise<void>;
}

type Colour = [number, number, number];

function mesh(name: string, geometry: THREE.BufferGeometry, colour: Colour, metalness: number, roughness: number): THREE.Mesh {
    const material = new THREE.MeshStandardMaterial({metalness, roughness, name});
    material.color.setRGB(...colour);
    const made = new THREE.Mesh(geometry, material);
    made.name = name;
    return made;
}

const gold: Colour = [1.0, 0.766, 0.336];
const red: Colour = [0.5, 0.05, 0.04];

/// Gold above red plastic; roughness 0 to 1 from left to right.
function spheres(): Model {
    const root = new THREE.Group(), geometry = sphere(64), columns = 7;
    for (let row = 0; row < 2; ++row)
        for (let column = 0; column < columns; ++column) {
            const roughness = column / (columns - 1), metal = row === 0;
            const name = `${metal ? 'metal' : 'dielectric'} ${roughness.toFixed(2)}`;
            const ball = mesh(name, geometry, metal ? gold : red, metal ? 1 : 0, roughness);
            ball.position.set(column - 3, metal ? 0.5 : -0.5, 0);
            ball.scale.setScalar(0.46);
            root.add(ball);
        }
    return {name: 'spheres', root, view: {eye: [0, 0, 20], target: [0, 0, 0], fovDeg: degrees(2 * Math.atan(3.65 / 2 / 20)), aspect: 2}, variants: []};
}

/// Roughness from left to right, metalness from the bottom up.
function grid(): Model {
    const root = new THREE.Group(), geometry = sphere(48), columns = 9, rows = 5;
    for (let row = 0; row < rows; ++row)
        for (let column = 0; column < columns; ++column) {
            const roughness = column / (columns - 1), metalness = row / (rows - 1);
            const name = `roughness ${roughness.toFixed(2)}, metalness ${metalness.toFixed(2)}`;
            const ball = mesh(name, geometry, [0.9, 0.55, 0.4], metalness, roughness);
            ball.position.set(column - (columns - 1) / 2, row - (rows - 1) / 2, 0);
            ball.scale.setScalar(0.45);
            root.add(ball);
        }
    return {name: 'grid', root, view: {eye: [0, 0, 24], target: [0, 0, 0], fovDeg: degrees(2 * Math.atan(2.9 / 24)), aspect: 1.7}, variants: []};
}

/// A ball with a groove, in a collar on a plinth.
function ball(): Model {
    const root = new THREE.Group(), half = Math.PI / 2, centre = 1.34, groove = 0.16;
    const outside = Math.cos(groove), inside = outside - 0.05, below = centre - Math.sin(groove), above = centre + Math.sin(groove);
    root.add(mesh('ball', lathe([arc(centre, 1, -half, -groove, 80), line(outside, below, inside, below), line(inside, below, inside, above),
                                 line(inside, above, outside, above), arc(centre, 1, groove, half, 80)], 192),
                  [0.955, 0.638, 0.538], 1, 0.25));
    const bevel = 0.04, low = 0.22, high = 0.62;
    root.add(mesh('plinth', lathe([line(1.1, 0, 1.1, low - bevel), arc(low - bevel, bevel, 0, half, 8, 1.1 - bevel),
                                   line(1.1 - bevel, low, 0.62 + bevel, low), line(0.62 + bevel, low, 0.72, high - bevel),
                                   arc(high - bevel, bevel, 0, half, 8, 0.72 - bevel), line(0.72 - bevel, high, 0, high)], 192),
                  [0.18, 0.18, 0.19], 0, 0.45));
    const ground = new THREE.PlaneGeometry(24, 24).rotateX(-half);
    root.add(mesh('ground', ground, [0.42, 0.42, 0.42], 0, 0.9));
    return {name: 'ball', root, view: {eye: [0, 2.6, 6.2], target: [0, 1.15, 0], fovDeg: degrees(0.52), aspect: 1}, variants: []};
}

/// White metal: what a white furnace must make disappear.
function furnace(): Model {
    const root = new THREE.Group();
    root.add(mesh('white', sphere(256), [1, 1, 1], 1, 0.5));
    return {name: 'furnace', root, view: {eye: [0, 0, 4.2], target: [0, 0, 0], fovDeg: degrees(0.61), aspect: 1}, variants: []};
}

const degrees = (radians: number) => (radians * 180) / Math.PI;

/// The environment alone, seen from within.
const none = (): Model => ({name: 'none', root: new THREE.Group(), view: {eye: [0, 0, 1], target: [0, 0, 0], fovDeg: 60, aspect: 1}, variants: []});

export const builtInModels: Record<string, () => Model> = {spheres, grid, ball, furnace, none};
