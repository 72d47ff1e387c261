// Reads what `domelight bake` writes for an engine of one's own (--for generic). HLSL, shader model 5 and later.
//
//   specular.ktx2      g_specular      cube; roughness = level / (levels - 1), level 0 is the environment itself
//   irradiance.ktx2    g_irradiance    cube of the irradiance E
//   brdf.ktx2          g_brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            g_sh            its nine "irradiance" coefficients, where the cube is too much
//
// (--format dds gives the same in DDS.) Sample the cubes with linear filtering between levels, the table with clamped
// edges. Directions are glTF's: right-handed with +Y up. A left-handed world gives its (x, y, -z).

TextureCube<float4> g_specular : register(t0);
TextureCube<float4> g_irradiance : register(t1);
Texture2D<float2> g_brdf : register(t2);
SamplerState g_linear_clamp : register(s0);
cbuffer Domelight : register(b0) {
    float4 g_sh[9];
    float g_last_level;  // levels - 1
};

static const float k_pi = 3.14159265358979;

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
float3 domelight_specular(float3 r, float roughness) {
    return g_specular.SampleLevel(g_linear_clamp, r, roughness * g_last_level).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
float3 domelight_diffuse(float3 n) {
    return g_irradiance.SampleLevel(g_linear_clamp, n, 0).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
float3 domelight_diffuse_sh(float3 n) {
    float3 e = 0.282095 * g_sh[0].xyz +
               0.488603 * (n.y * g_sh[1].xyz + n.z * g_sh[2].xyz + n.x * g_sh[3].xyz) +
               1.092548 * (n.x * n.y * g_sh[4].xyz + n.y * n.z * g_sh[5].xyz + n.z * n.x * g_sh[7].xyz) +
               0.315392 * (3.0 * n.z * n.z - 1.0) * g_sh[6].xyz +
               0.546274 * (n.x * n.x - n.y * n.y) * g_sh[8].xyz;
    return max(e, 0.0) / k_pi;
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
float3 domelight_shade(float3 n, float3 v, float3 base_color, float metallic, float roughness) {
    float NdotV = saturate(dot(n, v));
    float3 f0 = lerp(float3(0.04, 0.04, 0.04), base_color, metallic);
    float2 scale_bias = g_brdf.SampleLevel(g_linear_clamp, float2(NdotV, roughness), 0);
    float3 reflected = f0 * scale_bias.x + scale_bias.y;
    float3 diffuse = base_color * (1.0 - metallic) * (1.0 - reflected);
    return diffuse * domelight_diffuse(n) + reflected * domelight_specular(reflect(-v, n), roughness);
}
