// Modified Phong, rho_d / pi + rho_s (n_s + 2) / (2 pi) cos^n_s, under two prefiltered maps: Miller and Hoffman 1984. The diffuse map is
// read by the normal, the specular one by the mirror direction, with n = v = r. The C++ is src/render/shading/shading_phong.cpp. Behind
// diffuse.glsl and phong_chain.glsl or phong_probes.glsl, which have phong_light().

uniform float u_exponent;  // above 0: in place of the material's

/// The roughness that corresponds to an exponent by Beckmann's relation n = 2 / alpha^2 - 2: a coordinate in which levels are
/// interpolated.
float matching_roughness(float exponent) {
    return pow(2.0 / (exponent + 2.0), 0.25);
}

vec3 shade(Surface s, vec3 v) {
    float alpha = s.roughness * s.roughness;
    float exponent = u_exponent > 0.0 ? u_exponent : max(0.0, 2.0 / max(alpha * alpha, 1e-7) - 2.0);
    return (s.diffuse * diffuse_light(s.normal) + s.f0 * phong_light(reflect(-v, s.normal), exponent)) * s.occlusion;
}
