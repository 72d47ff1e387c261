// Sphere map, dual paraboloid, faces and octahedron: include/domelight/projection/projection.h. Points of a picture have the first row at v = 0.

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

/// Faces of 3 x 2: +X -X +Y above, -Y +Z -Z below, as docs/conventions.md draws them.
vec3 faces_direction(vec2 p) {
    ivec2 cell = ivec2(p * vec2(3.0, 2.0));
    vec2 st = fract(p * vec2(3.0, 2.0)) * 2.0 - 1.0;
    int face = cell.y * 3 + cell.x;
    if (face == 0) return vec3(1.0, -st.y, -st.x);
    if (face == 1) return vec3(-1.0, -st.y, st.x);
    if (face == 2) return vec3(st.x, 1.0, st.y);
    if (face == 3) return vec3(st.x, -1.0, -st.y);
    if (face == 4) return vec3(st.x, -st.y, 1.0);
    return vec3(-st.x, -st.y, -1.0);
}
vec2 faces_uv(vec3 d) {
    vec3 a = abs(d);
    int face = a.x >= a.y && a.x >= a.z ? (d.x > 0.0 ? 0 : 1) : a.y >= a.z ? (d.y > 0.0 ? 2 : 3) : (d.z > 0.0 ? 4 : 5);
    vec2 st = face == 0 ? vec2(-d.z, -d.y) : face == 1 ? vec2(d.z, -d.y)
            : face == 2 ? vec2(d.x, d.z)   : face == 3 ? vec2(d.x, -d.z)
            : face == 4 ? vec2(d.x, -d.y)  : vec2(-d.x, -d.y);
    st = 0.5 + 0.5 * st / max(a.x, max(a.y, a.z));
    return (vec2(float(face % 3), float(face / 3)) + st) / vec2(3.0, 2.0);
}

/// Octahedral: p = (x, z) / (|x| + |y| + |z|), its corners folded out where y < 0. Centre +Y, right +X, up +Z.
vec2 octahedral_fold(vec2 p) {
    return (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
}
vec2 octahedral_uv(vec3 d) {
    vec2 p = d.xz / (abs(d.x) + abs(d.y) + abs(d.z));
    return disc_uv(d.y < 0.0 ? octahedral_fold(p) : p);
}
vec3 octahedral_direction(vec2 uv) {
    vec2 p = disc_point(uv);
    float y = 1.0 - abs(p.x) - abs(p.y);
    if (y < 0.0) p = octahedral_fold(p);
    return normalize(vec3(p.x, y, p.y));
}
