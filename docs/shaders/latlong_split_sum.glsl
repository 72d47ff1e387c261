// Split-sum shading with lat-long maps. GLSL 3.30 and later, and ES 3.00; behind spherical_envmap.glsl.
// Reads what `domelight bake studio.hdr -o out --layout latlong` writes:
//
//   specular.ktx2      u_specular      lat-long; each level filtered for the roughness that domelight_level() reads it for
//   irradiance.ktx2    u_irradiance    lat-long map of the irradiance E
//   brdf.ktx2          u_brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//
// Linear filtering, between levels too; the table clamped, the others repeating in s and clamped in t. All lookups name
// their level: at the seam, where s jumps from 1 to 0, a level from derivatives would be the coarsest.

uniform sampler2D u_specular;
uniform sampler2D u_irradiance;
uniform sampler2D u_brdf;
uniform float u_last_level;  // levels - 1

/// The level to read for a roughness: a straight line up to the roughness of level 1, its logarithm from there on.
float domelight_level(float roughness) {
    float first = max(pow(0.6, u_last_level - 1.0), 0.08);
    return roughness <= first ? roughness / first : u_last_level - (u_last_level - 1.0) * log(roughness) / log(first);
}

/// What is left for the diffuse layer, so that a white surface in an even light reflects all of it.
vec3 domelight_diffuse_weight_energy(vec3 f0, vec2 scale_bias) {
    return 1.0 - (f0 * scale_bias.x + scale_bias.y);
}

/// The same as most courses write it, 1 - F(NdotV): rough white plastics become dark towards their edge.
vec3 domelight_diffuse_weight_fresnel(vec3 f0, float NdotV) {
    return 1.0 - (f0 + (1.0 - f0) * pow(1.0 - NdotV, 5.0));
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. Vectors of the world, of
/// unit length. reflectance: 0.5 is the 4 % of glTF.
vec3 domelight_shade_latlong(vec3 n, vec3 v, vec3 base_color, float metallic, float roughness, float reflectance) {
    float NdotV = clamp(dot(n, v), 0.0, 1.0);
    vec3 f0 = mix(vec3(0.16 * reflectance * reflectance), base_color, metallic);

    vec3 prefiltered = textureLod(u_specular, domelight_latlong_point(reflect(-v, n)), domelight_level(roughness)).rgb;
    vec2 scale_bias = textureLod(u_brdf, vec2(NdotV, roughness), 0.0).rg;
    vec3 specular = prefiltered * (f0 * scale_bias.x + scale_bias.y);

    vec3 irradiance = textureLod(u_irradiance, domelight_latlong_point(n), 0.0).rgb;
    vec3 kd = (1.0 - metallic) * domelight_diffuse_weight_energy(f0, scale_bias);  // or ..._fresnel(f0, NdotV)
    vec3 diffuse = kd * base_color * irradiance / k_pi;

    return diffuse + specular;
}
