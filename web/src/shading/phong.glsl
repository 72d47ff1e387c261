// Modified Phong, rho_d / pi + rho_s (n_s + 2) / (2 pi) cos^n_s, under two prefiltered maps: Miller and Hoffman 1984. The diffuse map is
// read by the normal, the specular one by the mirror direction, with n = v = r. The C++ is src/render/shading/shading_phong.cpp. Behind
// diffuse.glsl.

const int k_most_levels = 16;
uniform samplerCube u_phong;
uniform float u_phong_roughness[k_most_levels];  // of each level, by matching_roughness
uniform int u_phong_levels;
uniform float u_exponent;  // above 0: in place of the material's

/// The roughness that corresponds to an exponent by Beckmann's relation n = 2 / alpha^2 - 2: a coordinate in which levels are
/// interpolated.
float matching_roughness(float exponent) {
    return pow(2.0 / (exponent + 2.0), 0.25);
}

/// The light of a lobe. Below the exponent of the last level it is mixed with the irradiance, which has the exponent 0.
vec3 phong_light(vec3 r, float exponent) {
    float roughness = matching_roughness(exponent), last = u_phong_roughness[u_phong_levels - 1];
    float level = float(u_phong_levels - 1);
    for (int i = 1; i < u_phong_levels; ++i)
        if (roughness < u_phong_roughness[i]) {
            level = float(i) - (u_phong_roughness[i] - roughness) / (u_phong_roughness[i] - u_phong_roughness[i - 1]);
            break;
        }
    vec3 light = textureLod(u_phong, u_environment * r, level).rgb;
    if (roughness <= last || last >= 1.0) return light;
    return mix(light, domelight_diffuse(r), (roughness - last) / (1.0 - last));
}

vec3 shade(Surface s, vec3 v) {
    float alpha = s.roughness * s.roughness;
    float exponent = u_exponent > 0.0 ? u_exponent : max(0.0, 2.0 / max(alpha * alpha, 1e-7) - 2.0);
    return (s.diffuse * diffuse_light(s.normal) + s.f0 * phong_light(reflect(-v, s.normal), exponent)) * s.occlusion;
}
