// The chain of levels of modified Phong lobes of one environment. Before phong.glsl.

const int k_most_levels = 16;
uniform samplerCube u_phong;
uniform float u_phong_roughness[k_most_levels];  // of each level, by matching_roughness
uniform int u_phong_levels;

float matching_roughness(float exponent);

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
