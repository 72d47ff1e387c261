// A lat-long map of the environment as the screen shows it. Behind environment.glsl, bilinear.glsl and tonemap.glsl; the pages' own
// u_envmap has floats.

uniform sampler2D u_envmap;

/// The direction that a point of a lat-long map shows: docs/conventions.md. v runs down.
vec3 latlong_direction(vec2 point) {
    float phi = (point.x - 0.5) * k_turn, theta = point.y * 0.5 * k_turn;
    return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}

vec3 radiance_from(vec3 direction) {
    return bilinear(u_envmap, latlong_point(direction));
}
