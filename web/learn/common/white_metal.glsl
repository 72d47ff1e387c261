// The surface of the pages' balls. Behind web/src/shading/material.glsl.

Surface white_metal(vec3 normal, float roughness) {
    return Surface(vec3(0.0), normal, vec3(0.0), vec3(1.0), vec3(1.0), vec3(0.0), vec3(0.0), max(roughness, 0.03), 1.0, 1.5, true, false, vec3(0.0), 1.0);
}
