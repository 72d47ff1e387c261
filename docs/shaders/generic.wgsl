// Reads what `domelight bake` writes for an engine of one's own (--for generic). WGSL.
//
//   specular.ktx2      specular      cube; each level filtered for the roughness that domelight_level() reads it for
//   irradiance.ktx2    irradiance    cube of the irradiance E
//   brdf.ktx2          brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            light.sh      its nine "irradiance" coefficients, where the cube is too much
//
// Sample the cubes with linear filtering between levels, the table with clamped edges. The maps are
// right-handed with +Y up: nothing is flipped. Directions are the world's; light.environment turns them to the maps'.

struct Light {
    sh: array<vec4f, 9>,
    environment: mat3x3f,  // the identity where the world is the maps' own
    last_level: f32,       // levels - 1
}

@group(0) @binding(0) var specular: texture_cube<f32>;
@group(0) @binding(1) var irradiance: texture_cube<f32>;
@group(0) @binding(2) var brdf: texture_2d<f32>;
@group(0) @binding(3) var linear_clamp: sampler;
@group(0) @binding(4) var<uniform> light: Light;

const k_pi = 3.14159265358979;

/// The level to read for a roughness: a straight line up to the roughness of level 1, its logarithm from there on.
fn domelight_level(roughness: f32) -> f32 {
    let first = max(pow(0.6, light.last_level - 1.0), 0.08);
    if (roughness <= first) {
        return roughness / first;
    }
    return light.last_level - (light.last_level - 1.0) * log(roughness) / log(first);
}

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
fn domelight_specular(r: vec3f, roughness: f32) -> vec3f {
    return textureSampleLevel(specular, linear_clamp, light.environment * r, domelight_level(roughness)).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
fn domelight_diffuse(n: vec3f) -> vec3f {
    return textureSampleLevel(irradiance, linear_clamp, light.environment * n, 0.0).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
fn domelight_diffuse_sh(normal: vec3f) -> vec3f {
    let n = light.environment * normal;
    let e = 0.282095 * light.sh[0].xyz +
            0.488603 * (n.y * light.sh[1].xyz + n.z * light.sh[2].xyz + n.x * light.sh[3].xyz) +
            1.092548 * (n.x * n.y * light.sh[4].xyz + n.y * n.z * light.sh[5].xyz + n.z * n.x * light.sh[7].xyz) +
            0.315392 * (3.0 * n.z * n.z - 1.0) * light.sh[6].xyz +
            0.546274 * (n.x * n.x - n.y * n.y) * light.sh[8].xyz;
    return max(e, vec3f(0.0)) / k_pi;
}

/// F0 of a dielectric, from the reflectance in [0, 1] of an engine's material: 0.5 is 4 %, which glTF has by default.
fn domelight_f0_of_reflectance(reflectance: f32) -> f32 {
    return 0.16 * reflectance * reflectance;
}

/// What the specular layer reflects of an even light. `scale_bias`: of the BRDF table.
fn domelight_single_scattering(f0: vec3f, scale_bias: vec2f) -> vec3f {
    return f0 * scale_bias.x + scale_bias.y;
}

/// What it reflects besides, after more than one bounce between the microfacets. Fdez-Aguera 2019, listing 2.
fn domelight_multiple_scattering(f0: vec3f, scale_bias: vec2f) -> vec3f {
    let lost = 1.0 - (scale_bias.x + scale_bias.y);
    let mean = f0 + (1.0 - f0) / 21.0;
    return lost * domelight_single_scattering(f0, scale_bias) * mean / (1.0 - lost * mean);
}

/// The part of the light that is left for the diffuse layer: what the specular layer does not reflect, so that a white
/// surface in an even light reflects all of it. With multiple scattering, subtract that as well.
fn domelight_diffuse_weight_energy(f0: vec3f, scale_bias: vec2f) -> vec3f {
    return 1.0 - domelight_single_scattering(f0, scale_bias);
}

/// The same as most courses write it, 1 - F(NdotV). It does not keep the energy: a rough white plastic in an even light
/// becomes dark towards its edge.
fn domelight_diffuse_weight_fresnel(f0: vec3f, NdotV: f32) -> vec3f {
    return 1.0 - (f0 + (1.0 - f0) * pow(1.0 - NdotV, 5.0));
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
fn domelight_shade(n: vec3f, v: vec3f, base_color: vec3f, metallic: f32, roughness: f32) -> vec3f {
    let NdotV = clamp(dot(n, v), 0.0, 1.0);
    let f0 = mix(vec3f(domelight_f0_of_reflectance(0.5)), base_color, metallic);
    let scale_bias = textureSampleLevel(brdf, linear_clamp, vec2f(NdotV, roughness), 0.0).rg;
    let specular = domelight_single_scattering(f0, scale_bias);
    // For 1 - F(NdotV): domelight_diffuse_weight_fresnel(f0, NdotV).
    let diffuse = base_color * (1.0 - metallic) * domelight_diffuse_weight_energy(f0, scale_bias);
    return diffuse * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}

/// The same with multiple scattering: rough metals do not darken.
fn domelight_shade_multiple_scattering(n: vec3f, v: vec3f, base_color: vec3f, metallic: f32, roughness: f32) -> vec3f {
    let NdotV = clamp(dot(n, v), 0.0, 1.0);
    let f0 = mix(vec3f(domelight_f0_of_reflectance(0.5)), base_color, metallic);
    let scale_bias = textureSampleLevel(brdf, linear_clamp, vec2f(NdotV, roughness), 0.0).rg;
    let specular = domelight_single_scattering(f0, scale_bias);
    let multiple = domelight_multiple_scattering(f0, scale_bias);
    let weight = domelight_diffuse_weight_energy(f0, scale_bias) - multiple;
    let diffuse = base_color * (1.0 - metallic) * weight;
    return (diffuse + multiple) * domelight_diffuse(n) + specular * domelight_specular(reflect(-v, n), roughness);
}
