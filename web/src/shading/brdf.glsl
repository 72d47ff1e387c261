// The BRDF: glTF's, a Lambert layer below GGX microfacets. Vectors of the frame whose z is the normal. The C++ is src/render/surface/bsdf.h. Behind
// material.glsl and a file that declares k_pi.

float ggx_root(float cosine, float a2) {
    return sqrt(a2 + (1.0 - a2) * cosine * cosine);
}
/// D: Walter et al. 2007, eq. 33. h has any length.
float ggx_d(vec3 h, float a2) {
    float h2 = dot(h, h), d = h.z * h.z * a2 + (h.x * h.x + h.y * h.y);
    return a2 * h2 * h2 / (k_pi * d * d);
}
/// f times the cosine. compensation: of multiple scattering, (1 - E) / E at the viewer's angle; 0 without.
vec3 brdf_cosine(Surface s, vec3 v, vec3 l, float compensation) {
    if (l.z <= 0.0 || v.z <= 0.0) return vec3(0.0);
    vec3 h = v + l;
    float VdotH = 0.5 * length(h), schlick = pow(1.0 - min(VdotH, 1.0), 5.0), a2 = pow(s.roughness, 4.0);
    vec3 under = mix(s.dielectric_f0, s.dielectric_f90, schlick);
    // glTF 2.0, B.3.4: light that the layer above reflects does not reach the layer below.
    vec3 diffuse = s.diffuse * (1.0 - max(under.r, max(under.g, under.b))) / k_pi;
    float visibility = 0.5 / (l.z * ggx_root(v.z, a2) + v.z * ggx_root(l.z, a2));
    return (diffuse + mix(s.f0, s.f90, schlick) * (1.0 + s.f0 * compensation) * (ggx_d(h, a2) * visibility)) * l.z;
}

/// A frame about a normal: Duff et al. 2017.
mat3 frame_of(vec3 n) {
    float side = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}
