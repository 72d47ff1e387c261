// Light of a diffuse layer: E / pi by the cube, or by nine harmonics. Behind docs/shaders/generic.glsl.

uniform bool u_harmonics;

vec3 diffuse_light(vec3 n) {
    return u_harmonics ? domelight_diffuse_sh(n) : domelight_diffuse(n);
}
