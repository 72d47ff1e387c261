// The environment itself, as the lat-long map that was read: convention `default` of docs/conventions.md, the first row at v = 0.

uniform sampler2D u_latlong;
uniform mat3 u_turn;  // from directions of the world to those of the map

const float k_turn = 6.28318530717959;

vec2 latlong_point(vec3 d) {
    float side = length(d.xz);
    return vec2(0.5 + (side > 0.0 ? atan(d.z, d.x) : 0.0) / k_turn, atan(side, d.y) / (0.5 * k_turn));
}

/// Radiance from a direction of the world, bilinear between texels.
vec3 environment_light(vec3 d) {
    return textureLod(u_latlong, latlong_point(u_turn * d), 0.0).rgb;
}
