// Reads what `domelight bake` writes for an engine of one's own (--for generic). HLSL, shader model 5 and later.
//
//   specular.ktx2      g_specular      cube; each level filtered for the roughness that domelight_level() reads it for
//   irradiance.ktx2    g_irradiance    cube of the irradiance E
//   brdf.ktx2          g_brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            g_sh            its nine "irradiance" coefficients, where the cube is too much
//
// (--format dds gives the same in DDS.) Sample the cubes with linear filtering between levels, the table with clamped
// edges. The maps are glTF's: right-handed with +Y up. Directions are the world's; g_environment turns them to those of
// the maps. A left-handed world has the rows (1, 0, 0), (0, 1, 0) and (0, 0, -1) there.

TextureCube<float4> g_specular : register(t0);
TextureCube<float4> g_irradiance : register(t1);
Texture2D<float2> g_brdf : register(t2);
SamplerState g_linear_clamp : register(s0);
cbuffer Domelight : register(b0) {
    float4 g_sh[9];
    float4 g_environment[3];  // the rows of a matrix: the identity where the world is the maps' own
    float g_last_level;       // levels - 1
};

static const float k_pi = 3.14159265358979;

/// The direction in which the maps show what the world has in direction d.
float3 domelight_direction(float3 d) {
    return float3(dot(g_environment[0].xyz, d), dot(g_environment[1].xyz, d), dot(g_environment[2].xyz, d));
}

/// The level to read for a roughness: a straight line up to the roughness of level 1, its logarithm from there on.
float domelight_level(float roughness) {
    float first = max(pow(0.6, g_last_level - 1.0), 0.08);
    return roughness <= first ? roughness / first : g_last_level - (g_last_level - 1.0) * log(roughness) / log(first);
}

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
float3 domelight_specular(float3 r, float roughness) {
    return g_specular.SampleLevel(g_linear_clamp, domelight_direction(r), domelight_level(roughness)).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
float3 domelight_diffuse(float3 n) {
    return g_irradiance.SampleLevel(g_linear_clamp, domelight_direction(n), 0).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
float3 domelight_diffuse_sh(float3 normal) {
    float3 n = domelight_direction(normal);
    float3 e = 0.282095 * g_sh[0].xyz +
               0.488603 * (n.y * g_sh[1].xyz + n.z * g_sh[2].xyz + n.x * g_sh[3].xyz) +
               1.092548 * (n.x * n.y * g_sh[4].xyz + n.y * n.z * g_sh[5].xyz + n.z * n.x * g_sh[7].xyz) +
               0.315392 * (3.0 * n.z * n.z - 1.0) * g_sh[6].xyz +
               0.546274 * (n.x * n.x - n.y * n.y) * g_sh[8].xyz;
    return max(e, 0.0) / k_pi;
}

/// F0 of a dielectric, from the reflectance in [0, 1] of an engine's material: 0.5 is 4 %, which glTF has by default.
float domelight_f0_of_reflectance(float reflectance) {
    return 0.16 * reflectance * reflectance;
}

/// What the specular layer reflects of an even light. `scale_bias`: of the BRDF table.
float3 domelight_single_scattering(float3 f0, float2 scale_bias) {
    return f0 * scale_bias.x + scale_bias.y;
}

/// What it reflects besides, after more than one bounce between the microfacets. Fdez-Aguera 2019, listing 2.
float3 domelight_multiple_scattering(float3 f0, float2 scale_bias) {
    float lost = 1.0 - (scale_bias.x + scale_bias.y);
    float3 mean = f0 + (1.0 - f0) / 21.0;
    return lost * domelight_single_scattering(f0, scale_bias) * mean / (1.0 - lost * mean);
}

/// The part of the light that is left for the diffuse layer: what the specular layer does not reflect, so that a white
/// surface in an even light reflects all of it. With multiple scattering, subtract that as well.
float3 domelight_diffuse_weight_energy(float3 f0, float2 scale_bias) {
    return 1.0 - domelight_single_scattering(f0, scale_bias);
}

/// The same as most courses write it, 1 - F(NdotV). It does not keep the energy: a rough white plastic in an even light
/// becomes dark towards its edge.
float3 domelight_diffuse_weight_fresnel(float3 f0, float NdotV) {
    return 1.0 - (f0 + (1.0 - f0) * pow(1.0 - NdotV, 5.0));
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
float3 domelight_shade(float3 n, float3 v, float3 base_color, float metallic, float roughness) {
    float NdotV = saturate(dot(n, v));
    float3 f0 = lerp((float3)domelight_f0_of_reflectance(0.5), base_color, metallic);
    float2 scale_bias = g_brdf.SampleLevel(g_linear_clamp, float2(NdotV, roughness), 0);
    float3 specular = domelight_single_scattering(f0, scale_bias);
    // For 1 - F(NdotV): domelight_diffuse_weight_fresnel(f0, NdotV).
    float3 diffuse = base_color * (1.0 - metallic) * domelight_diffuse_weight_energy(f0, scale_bias);
    return diffuse * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}

/// The same with multiple scattering: rough metals do not darken.
float3 domelight_shade_multiple_scattering(float3 n, float3 v, float3 base_color, float metallic, float roughness) {
    float NdotV = saturate(dot(n, v));
    float3 f0 = lerp((float3)domelight_f0_of_reflectance(0.5), base_color, metallic);
    float2 scale_bias = g_brdf.SampleLevel(g_linear_clamp, float2(NdotV, roughness), 0);
    float3 specular = domelight_single_scattering(f0, scale_bias);
    float3 multiple = domelight_multiple_scattering(f0, scale_bias);
    float3 weight = domelight_diffuse_weight_energy(f0, scale_bias) - multiple;
    float3 diffuse = base_color * (1.0 - metallic) * weight;
    return (diffuse + multiple) * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}
