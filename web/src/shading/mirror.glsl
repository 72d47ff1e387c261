// Reflection mapping: Blinn and Newell 1976. The sharp environment in the mirror direction r = 2 (n v) n - v, whatever the material.
// The C++ is src/render/shading/shading_mirror.cpp. Behind lookup.glsl.

float highlight_f0(Surface s) {
    return 1.0;
}

vec3 shade(Surface s, vec3 v) {
    return mapped_light(reflect(-v, s.normal));
}
