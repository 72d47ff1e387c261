// The lights of a model as the uniforms of shading/lights.glsl.

import * as THREE from 'three';

export const k_most_lights = 16;
/// What glTF calls one lux, where the file does not say it: that of a watt at 555 nm, as `domelight render` has it.
const k_lux_per_unit = 683;
const kinds = {directional: 0, point: 1, spot: 2};

/// Four vectors of each light, as they are placed now. Lights beyond k_most_lights are left out.
export function lightVectors(root: THREE.Object3D): THREE.Vector4[] {
    const found: THREE.Vector4[] = [], v = (x: number, y: number, z: number, w: number) => new THREE.Vector4(x, y, z, w);
    root.updateMatrixWorld(true);
    root.traverse(object => {
        const light = object as THREE.PointLight & THREE.SpotLight & THREE.DirectionalLight;
        if (!light.isLight || found.length >= 4 * k_most_lights) return;
        const kind = light.isSpotLight ? kinds.spot : light.isPointLight ? kinds.point : kinds.directional;
        const place = new THREE.Vector3().setFromMatrixPosition(light.matrixWorld), way = new THREE.Vector3(0, 0, -1).transformDirection(light.matrixWorld);
        const {r, g, b} = light.color, outer = light.angle ?? 0, intensity = light.intensity / (light.userData.lux_per_unit ?? root.userData.luxPerUnit ?? k_lux_per_unit);
        found.push(v(place.x, place.y, place.z, kind), v(way.x, way.y, way.z, light.distance > 0 ? 1 / light.distance : 0),
                   v(r * intensity, g * intensity, b * intensity, Math.cos(outer * (1 - (light.penumbra ?? 0)))), v(Math.cos(outer), 0, 0, 0));
    });
    return found;
}
