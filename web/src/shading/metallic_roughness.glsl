// The surface of split-sum and of what goes beyond it: Karis 2013, "Real Shading in Unreal Engine 4". docs/math/split-sum.md derives it line by line. Behind
// diffuse.glsl; the C++ is src/render/shading/shading_split_sum.cpp.

uniform bool u_multiple_scattering;
uniform bool u_fresnel_weight;

/// Specular occlusion from the ambient one: Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", listing 26.
float specular_occlusion(float NdotV, float occlusion, float alpha) {
    return clamp(pow(NdotV + occlusion, exp2(-16.0 * alpha - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

/// A surface for a given light of its specular lobe: the part that F0 multiplies, and the part that F90 multiplies.
vec3 shade_metallic_roughness(Surface s, float NdotV, vec3 scale_light, vec3 bias_light) {
    vec3 e = diffuse_light(s.normal);
    vec2 scale_bias = textureLod(u_brdf, vec2(NdotV, s.roughness), 0.0).rg;
    vec3 single = s.f0 * scale_bias.x + s.f90 * scale_bias.y;
    vec3 specular = scale_light * s.f0 * scale_bias.x + bias_light * s.f90 * scale_bias.y;
    vec3 weight = u_fresnel_weight ? 1.0 - (s.f0 + (s.f90 - s.f0) * pow(1.0 - NdotV, 5.0)) : 1.0 - single;
    if (u_multiple_scattering) {
        // Fdez-Aguera 2019, listing 2; domelight_multiple_scattering() is the same for F90 = 1.
        float lost = 1.0 - (scale_bias.x + scale_bias.y);
        vec3 mean = s.f0 + (1.0 - s.f0) / 21.0;
        vec3 multiple = lost * single * mean / (1.0 - lost * mean);
        specular += multiple * e;
        if (!u_fresnel_weight) weight -= multiple;
    }
    vec3 diffuse = s.diffuse * weight * e * s.occlusion;
    return diffuse + specular * specular_occlusion(NdotV, s.occlusion, s.roughness * s.roughness);
}
