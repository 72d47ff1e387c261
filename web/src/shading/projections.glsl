// Sphere map and dual paraboloid: include/domelight/projection/projection.h. Points of a picture have the first row at v = 0.

vec2 disc_point(vec2 uv) {
    return vec2(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
}
vec2 disc_uv(vec2 p) {
    return vec2(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y);
}

/// OpenGL's sphere map, centre +Z: p = h.xy with h = normalize(d + e_z). OpenGL 2.1, 2.11.4. d has unit length.
vec2 sphere_map_uv(vec3 d) {
    float side = length(d.xy);
    if (d.z >= 0.0) return disc_uv(normalize(vec3(d.xy, d.z + 1.0)).xy);
    if (side == 0.0) return disc_uv(vec2(1.0, 0.0));
    // Near -Z, 1 + z has no digits left; instead (1 + z) / side = side / (1 - z).
    float slope = side / (1.0 - d.z);
    return disc_uv(d.xy / (side * sqrt(1.0 + slope * slope)));
}
vec3 sphere_map_direction(vec2 uv) {
    vec2 p = disc_point(uv);
    float hz2 = max(0.0, 1.0 - dot(p, p));
    return vec3(2.0 * sqrt(hz2) * p, 2.0 * hz2 - 1.0);
}

/// Heidrich and Seidel 1998, "View-independent environment maps": the paraboloid about +Z or -Z. d has unit length.
vec2 paraboloid_uv(bool back, vec3 d) {
    return disc_uv(d.xy / (1.0 + (back ? -d.z : d.z)));
}
vec3 paraboloid_direction(bool back, vec2 uv) {
    vec2 p = disc_point(uv);
    float s = dot(p, p), z = (1.0 - s) / (1.0 + s);
    return vec3(2.0 * p / (1.0 + s), back ? -z : z);
}
