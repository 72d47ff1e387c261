// Reads what `domelight bake` writes for an engine of one's own (--for generic). GLSL 3.30 and later, and ES 3.00.
//
//   specular.ktx2      u_specular      cube; each level filtered for the roughness that domelight_level() reads it for
//   irradiance.ktx2    u_irradiance    cube of the irradiance E
//   brdf.ktx2          u_brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            u_sh            its nine "irradiance" coefficients, where the cube is too much
//
// Sample the cubes with linear filtering between levels, the table with clamped edges. The maps are right-handed with
// +Y up: nothing is flipped. Directions are the world's; u_environment turns them to the maps'.

uniform samplerCube u_specular;
uniform samplerCube u_irradiance;
uniform sampler2D u_brdf;
uniform float u_last_level;  // levels - 1
uniform vec3 u_sh[9];
uniform mat3 u_environment;  // the identity where the world is the maps' own

const float k_pi = 3.14159265358979;

/// The level to read for a roughness: a straight line up to the roughness of level 1, its logarithm from there on.
float domelight_level(float roughness) {
    float first = max(pow(0.6, u_last_level - 1.0), 0.08);
    return roughness <= first ? roughness / first : u_last_level - (u_last_level - 1.0) * log(roughness) / log(first);
}

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
vec3 domelight_specular(vec3 r, float roughness) {
    return textureLod(u_specular, u_environment * r, domelight_level(roughness)).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
vec3 domelight_diffuse(vec3 n) {
    return texture(u_irradiance, u_environment * n).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
vec3 domelight_diffuse_sh(vec3 normal) {
    vec3 n = u_environment * normal;
    vec3 e = 0.282095 * u_sh[0] +
             0.488603 * (n.y * u_sh[1] + n.z * u_sh[2] + n.x * u_sh[3]) +
             1.092548 * (n.x * n.y * u_sh[4] + n.y * n.z * u_sh[5] + n.z * n.x * u_sh[7]) +
             0.315392 * (3.0 * n.z * n.z - 1.0) * u_sh[6] +
             0.546274 * (n.x * n.x - n.y * n.y) * u_sh[8];
    return max(e, vec3(0.0)) / k_pi;
}

/// F0 of a dielectric, from the reflectance in [0, 1] of an engine's material: 0.5 is 4 %, which glTF has by default.
float domelight_f0_of_reflectance(float reflectance) {
    return 0.16 * reflectance * reflectance;
}

/// What the specular layer reflects of an even light. `scale_bias`: of the BRDF table.
vec3 domelight_single_scattering(vec3 f0, vec2 scale_bias) {
    return f0 * scale_bias.x + scale_bias.y;
}

/// What it reflects besides, after more than one bounce between the microfacets. Fdez-Aguera 2019, listing 2.
vec3 domelight_multiple_scattering(vec3 f0, vec2 scale_bias) {
    float lost = 1.0 - (scale_bias.x + scale_bias.y);
    vec3 mean = f0 + (1.0 - f0) / 21.0;
    return lost * domelight_single_scattering(f0, scale_bias) * mean / (1.0 - lost * mean);
}

/// The part of the light that is left for the diffuse layer: what the specular layer does not reflect, so that a white
/// surface in an even light reflects all of it. With multiple scattering, subtract that as well.
vec3 domelight_diffuse_weight_energy(vec3 f0, vec2 scale_bias) {
    return 1.0 - domelight_single_scattering(f0, scale_bias);
}

/// The same as most courses write it, 1 - F(NdotV). It does not keep the energy: a rough white plastic in an even light
/// becomes dark towards its edge.
vec3 domelight_diffuse_weight_fresnel(vec3 f0, float NdotV) {
    return 1.0 - (f0 + (1.0 - f0) * pow(1.0 - NdotV, 5.0));
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
vec3 domelight_shade(vec3 n, vec3 v, vec3 base_color, float metallic, float roughness) {
    float NdotV = clamp(dot(n, v), 0.0, 1.0);
    vec3 f0 = mix(vec3(domelight_f0_of_reflectance(0.5)), base_color, metallic);
    vec2 scale_bias = textureLod(u_brdf, vec2(NdotV, roughness), 0.0).rg;
    vec3 specular = domelight_single_scattering(f0, scale_bias);
    // For 1 - F(NdotV): domelight_diffuse_weight_fresnel(f0, NdotV).
    vec3 diffuse = base_color * (1.0 - metallic) * domelight_diffuse_weight_energy(f0, scale_bias);
    return diffuse * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}

/// The same with multiple scattering: rough metals do not darken.
vec3 domelight_shade_multiple_scattering(vec3 n, vec3 v, vec3 base_color, float metallic, float roughness) {
    float NdotV = clamp(dot(n, v), 0.0, 1.0);
    vec3 f0 = mix(vec3(domelight_f0_of_reflectance(0.5)), base_color, metallic);
    vec2 scale_bias = textureLod(u_brdf, vec2(NdotV, roughness), 0.0).rg;
    vec3 specular = domelight_single_scattering(f0, scale_bias);
    vec3 multiple = domelight_multiple_scattering(f0, scale_bias);
    vec3 weight = domelight_diffuse_weight_energy(f0, scale_bias) - multiple;
    vec3 diffuse = base_color * (1.0 - metallic) * weight;
    return (diffuse + multiple) * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}
