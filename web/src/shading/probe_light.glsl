// The light of the blended probes, under the names by which docs/shaders/generic.glsl offers that of one environment. The C++ is src/probe/probe_blend.cpp and
// probe_set.cpp. Behind probe_blend.glsl.

uniform sampler2D u_brdf;
uniform highp sampler2DArray u_probe_specular;    // web/src/probes/atlas.ts
const int k_most_probe_levels = 16;
uniform vec3 u_probe_levels[k_most_probe_levels];  // texels along a side of a face, first row in the atlas, roughness
uniform int u_probe_last_level;
uniform bool u_probe_parallax;

const float k_pi = 3.14159265358979;

/// Where a probe's cube is read for what the point sees in a direction, if the walls are those of the probe's box: from the probe to where the ray leaves the box.
/// Lagarde and Zanuttini 2012.
vec3 parallax_direction(int probe, vec3 direction) {
    if (!u_probe_parallax || !probe_has_proxy(probe)) return direction;
    vec3 low = probe_record(probe, 1).xyz, high = probe_record(probe, 2).xyz, start = clamp(blend_point, low, high);
    vec3 along = (mix(low, high, greaterThan(direction, vec3(0.0))) - start) / direction;
    float t = 1e30;
    for (int k = 0; k < 3; ++k)
        if (direction[k] != 0.0) t = min(t, along[k]);
    vec3 seen = start + direction * t - probe_position(probe);
    return dot(seen, seen) > 0.0 ? seen : direction;
}

/// Radiance mirrored by a surface of that roughness. `r`: reflect(-v, n).
vec3 domelight_specular(vec3 r, float roughness) {
    int above = 1;
    while (above <= u_probe_last_level && u_probe_levels[above].z <= roughness) ++above;
    vec3 low = u_probe_levels[above - 1], high = u_probe_levels[min(above, u_probe_last_level)];
    float t = above > u_probe_last_level ? 0.0 : low.z > 0.0 ? log(roughness / low.z) / log(high.z / low.z) : roughness / high.z;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < blend_count; ++i) {
        int probe = blend_probes[i];
        vec3 point = face_point(parallax_direction(probe, r));
        vec3 light = atlas_light(u_probe_specular, probe, point, low.x, low.y);
        if (t > 0.0) light = mix(light, atlas_light(u_probe_specular, probe, point, high.x, high.y), t);
        sum += blend_weights[i] * light;
    }
    return sum;
}

/// Radiance that leaves a white diffuse surface: E / pi.
vec3 domelight_diffuse(vec3 n) {
    vec3 sum = vec3(0.0), point = face_point(n);
    for (int i = 0; i < blend_count; ++i) sum += blend_weights[i] * probe_diffuse(blend_probes[i], point);
    return sum;
}

/// The same from the harmonics, of each probe not below 0: docs/conventions.md, "Spherical harmonics".
vec3 domelight_diffuse_sh(vec3 n) {
    float basis[9] = float[9](0.282095, 0.488603 * n.y, 0.488603 * n.z, 0.488603 * n.x, 1.092548 * n.x * n.y, 1.092548 * n.y * n.z,
                              0.315392 * (3.0 * n.z * n.z - 1.0), 1.092548 * n.z * n.x, 0.546274 * (n.x * n.x - n.y * n.y));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < blend_count; ++i) {
        vec3 e = vec3(0.0);
        for (int k = 0; k < 9; ++k) e += basis[k] * probe_record(blend_probes[i], 5 + k).rgb;
        sum += blend_weights[i] * max(e, vec3(0.0));
    }
    return sum;
}
