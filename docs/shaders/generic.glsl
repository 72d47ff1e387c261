// Reads what `domelight bake` writes for an engine of one's own (--for generic). GLSL 3.30 and later, and ES 3.00.
//
//   specular.ktx2      u_specular      cube; roughness = level / (levels - 1), level 0 is the environment itself
//   irradiance.ktx2    u_irradiance    cube of the irradiance E
//   brdf.ktx2          u_brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            u_sh            its nine "irradiance" coefficients, where the cube is too much
//
// Sample the cubes with linear filtering between levels, the table with clamped edges. Directions are the world's,
// right-handed with +Y up: nothing is flipped.

uniform samplerCube u_specular;
uniform samplerCube u_irradiance;
uniform sampler2D u_brdf;
uniform float u_last_level;  // levels - 1
uniform vec3 u_sh[9];

const float k_pi = 3.14159265358979;

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
vec3 domelight_specular(vec3 r, float roughness) {
    return textureLod(u_specular, r, roughness * u_last_level).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
vec3 domelight_diffuse(vec3 n) {
    return texture(u_irradiance, n).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
vec3 domelight_diffuse_sh(vec3 n) {
    vec3 e = 0.282095 * u_sh[0] +
             0.488603 * (n.y * u_sh[1] + n.z * u_sh[2] + n.x * u_sh[3]) +
             1.092548 * (n.x * n.y * u_sh[4] + n.y * n.z * u_sh[5] + n.z * n.x * u_sh[7]) +
             0.315392 * (3.0 * n.z * n.z - 1.0) * u_sh[6] +
             0.546274 * (n.x * n.x - n.y * n.y) * u_sh[8];
    return max(e, vec3(0.0)) / k_pi;
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
vec3 domelight_shade(vec3 n, vec3 v, vec3 base_color, float metallic, float roughness) {
    float NdotV = clamp(dot(n, v), 0.0, 1.0);
    vec3 f0 = mix(vec3(0.04), base_color, metallic);
    vec2 scale_bias = textureLod(u_brdf, vec2(NdotV, roughness), 0.0).rg;
    vec3 reflected = f0 * scale_bias.x + scale_bias.y;
    vec3 diffuse = base_color * (1.0 - metallic) * (1.0 - reflected);
    return diffuse * domelight_diffuse(n) + reflected * domelight_specular(reflect(-v, n), roughness);
}
