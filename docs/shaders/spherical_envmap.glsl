// The lat-long mapping s = 1 - mod(phi / 2 pi, 1). GLSL 3.30 and later, and ES 3.00. The other lat-long
// shaders (latlong_split_sum.glsl, latlong_phong.glsl, sample_envmap.glsl) come after this text in the same source. ES
// wants `precision highp float; precision highp sampler2D;` before it.
//
//   u_environment      turns directions of the world to those of the map's own space, which has +Z up and shows -X in
//                      the middle of the map and +Y right of it. By rows:
//
//   world              file of convention `mod`            file by domelight (convention `default`)
//   +Z up              ( 1 0 0) (0 1  0) (0 0 1)           (-1 0 0) (0 -1 0) (0 0 1)
//   +Y up, as in glTF  ( 1 0 0) (0 0 -1) (0 1 0)           (-1 0 0) (0  0 1) (0 1 0)
//
// A light that the world turns by a matrix R has the product of this matrix and the inverse of R. (Where a matrix is
// given to OpenGL by columns, transpose these.)

uniform mat3 u_environment;

const float k_pi = 3.14159265358979;

/// The point (s, t) of a lat-long map, both in [0, 1], that shows a direction of unit length of the map's own space.
/// s runs to the right. t runs up: 0 is straight down and 1 is straight up, as OpenGL counts the rows of a texture
/// whose bottom row was uploaded first. domelight_latlong_point is for those whose top row was. (Within 0.02 degrees of
/// the poles the arc cosine of a float has no digits left.)
vec2 directionToSphericalEnvmap(vec3 dir) {
    float s = 1.0 - mod(atan(dir.y, dir.x) / (2.0 * k_pi), 1.0);
    float t = 1.0 - acos(clamp(dir.z, -1.0, 1.0)) / k_pi;
    return vec2(s, t);
}

/// Its inverse: the direction that the point (s, t) shows.
vec3 sphericalEnvmapToDirection(vec2 st) {
    float phi = 2.0 * k_pi * (1.0 - st.x);
    float theta = k_pi * (1.0 - st.y);
    return vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/// Texture coordinates of a direction of the world, for files whose first row is the top one, as all that domelight
/// writes, uploaded as they are. The texture repeats in s and is clamped in t.
vec2 domelight_latlong_point(vec3 direction) {
    vec2 st = directionToSphericalEnvmap(u_environment * direction);
    return vec2(st.x, 1.0 - st.y);
}

/// Its inverse.
vec3 domelight_latlong_direction(vec2 point) {
    return transpose(u_environment) * sphericalEnvmapToDirection(vec2(point.x, 1.0 - point.y));
}
