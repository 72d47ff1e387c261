// Reads what `domelight bake` writes for an engine of one's own (--for generic). WGSL.
//
//   specular.ktx2      specular      cube; roughness = level / (levels - 1), level 0 is the environment itself
//   irradiance.ktx2    irradiance    cube of the irradiance E
//   brdf.ktx2          brdf          u = NdotV, v = roughness with row 0 the smoothest; (scale, bias)
//   sh.json            light.sh      its nine "irradiance" coefficients, where the cube is too much
//
// Sample the cubes with linear filtering between levels, the table with clamped edges. Directions are the world's,
// right-handed with +Y up: nothing is flipped.

struct Light {
    sh: array<vec4f, 9>,
    last_level: f32,  // levels - 1
}

@group(0) @binding(0) var specular: texture_cube<f32>;
@group(0) @binding(1) var irradiance: texture_cube<f32>;
@group(0) @binding(2) var brdf: texture_2d<f32>;
@group(0) @binding(3) var linear_clamp: sampler;
@group(0) @binding(4) var<uniform> light: Light;

const k_pi = 3.14159265358979;

/// Radiance mirrored by a surface of that roughness, filtered over its lobe. `r`: reflect(-v, n).
fn domelight_specular(r: vec3f, roughness: f32) -> vec3f {
    return textureSampleLevel(specular, linear_clamp, r, roughness * light.last_level).rgb;
}

/// Radiance that leaves a white diffuse surface: E / pi.
fn domelight_diffuse(n: vec3f) -> vec3f {
    return textureSampleLevel(irradiance, linear_clamp, n, 0.0).rgb / k_pi;
}

/// The same from the harmonics: real, orthonormal, without the Condon-Shortley sign, polar axis +Z.
fn domelight_diffuse_sh(n: vec3f) -> vec3f {
    let e = 0.282095 * light.sh[0].xyz +
            0.488603 * (n.y * light.sh[1].xyz + n.z * light.sh[2].xyz + n.x * light.sh[3].xyz) +
            1.092548 * (n.x * n.y * light.sh[4].xyz + n.y * n.z * light.sh[5].xyz + n.z * n.x * light.sh[7].xyz) +
            0.315392 * (3.0 * n.z * n.z - 1.0) * light.sh[6].xyz +
            0.546274 * (n.x * n.x - n.y * n.y) * light.sh[8].xyz;
    return max(e, vec3f(0.0)) / k_pi;
}

/// Light from all around, seen along -v on a surface of glTF's metallic-roughness material. All vectors of unit length.
fn domelight_shade(n: vec3f, v: vec3f, base_color: vec3f, metallic: f32, roughness: f32) -> vec3f {
    let NdotV = clamp(dot(n, v), 0.0, 1.0);
    let f0 = mix(vec3f(0.04), base_color, metallic);
    let scale_bias = textureSampleLevel(brdf, linear_clamp, vec2f(NdotV, roughness), 0.0).rg;
    let reflected = f0 * scale_bias.x + scale_bias.y;
    let diffuse = base_color * (1.0 - metallic) * (1.0 - reflected);
    return diffuse * domelight_diffuse(n) + reflected * domelight_specular(reflect(-v, n), roughness);
}
