// Whether a probe sees a point, by the distances that it has captured. The C++ is src/probe/distance_lookup.cpp and probe_blend.cpp. Behind probe_records.glsl.

uniform highp sampler2DArray u_probe_distances;  // web/src/probes/distances.ts: s, t, 1 / z and the variance of each texel
uniform int u_probe_distance_size;               // 0: there are none

const int k_distance_border = 2;

/// 1 / z at (s, t) of the plane through three surfaces; 0 if they do not define one.
float on_plane(vec3 a, vec3 b, vec3 c, vec2 p) {
    if (!(a.z > 0.0 && b.z > 0.0 && c.z > 0.0)) return 0.0;
    vec3 ab = b - a, ac = c - a;
    float d = ab.x * ac.y - ab.y * ac.x;
    if (d == 0.0) return 0.0;
    return a.z + ((ab.z * ac.y - ac.z * ab.y) * (p.x - a.x) + (ac.z * ab.x - ab.z * ac.x) * (p.y - a.y)) / d;
}

/// The mean distance in a direction, and its variance, between the centres of texels: exact for walls and for the corners in which they meet.
vec2 probe_distance(int probe, vec3 direction) {
    vec3 point = face_point(direction);
    int size = u_probe_distance_size, face = int(point.z), across = size + 2 * k_distance_border;
    ivec2 origin = ivec2(face % 3, face / 3) * across + k_distance_border;
    vec2 at = (point.xy * 0.5 + 0.5) * float(size) - 0.5, low = clamp(floor(at), vec2(-1.0), vec2(size - 1)), part = at - low;
    float bilinear = 0.0, planes = 0.0, variance = 0.0, means[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), texel = origin + ivec2(low) + corner, step = 2 * corner - 1;
        vec2 near = mix(1.0 - part, part, vec2(corner));
        vec4 here = texelFetch(u_probe_distances, ivec3(texel, probe), 0);
        bilinear += near.x * near.y * here.z;
        variance += near.x * near.y * here.w;
        means[i] = sqrt(1.0 + dot(here.xy, here.xy)) / here.z;
        planes = max(planes, on_plane(here.xyz, texelFetch(u_probe_distances, ivec3(texel + ivec2(step.x, 0), probe), 0).xyz,
                                      texelFetch(u_probe_distances, ivec3(texel + ivec2(0, step.y), probe), 0).xyz, point.xy));
    }
    float reciprocal = clamp(planes, bilinear * (1.0 - 2.0 / float(size + 2)), bilinear);
    // A slope causes variance within a texel, which says nothing about what hides what.
    vec4 rise = vec4(means[1] - means[0], means[3] - means[2], means[2] - means[0], means[3] - means[1]);
    return vec2(sqrt(1.0 + dot(point.xy, point.xy)) / reciprocal, max(0.0, variance - dot(rise, rise) / 24.0));
}

/// Chebyshev's inequality (Donnelly and Lauritzen 2006, eq. 5), cubed (Majercik et al. 2019). moments: mean and variance.
float chebyshev_visibility(vec2 moments, float reach) {
    float behind = reach - moments.x;
    if (!(behind > 0.0)) return 1.0;
    float narrowest = 0.0025 * moments.x, variance = max(moments.y, narrowest * narrowest);
    const float least = 0.1;
    float v = max(0.0, (variance / (variance + behind * behind) - least) / (1.0 - least));
    return v * v * v;
}

float probe_visibility(int probe, vec3 from_probe, float reach) {
    if (u_probe_distance_size == 0) return 1.0;
    return chebyshev_visibility(probe_distance(probe, from_probe), reach * (1.0 - 0.3 / float(u_probe_distance_size)));
}
