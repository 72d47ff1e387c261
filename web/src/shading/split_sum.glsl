// Split-sum: Karis 2013, "Real Shading in Unreal Engine 4". docs/math/split-sum.md derives it line by line. The C++ is
// src/render/shading/shading_split_sum.cpp. Behind metallic_roughness.glsl.

uniform bool u_bent_lookup;

/// The mirror direction, or one between it and the normal, nearer to the normal the rougher the surface is (Lagarde and de Rousiers 2014, listing 21).
vec3 lookup_direction(vec3 n, vec3 v, float roughness) {
    vec3 r = reflect(-v, n);
    float smoothness = 1.0 - roughness;
    float lean = smoothness * (sqrt(smoothness) + roughness);
    return u_bent_lookup ? n + (r - n) * lean : r;
}

vec3 shade(Surface s, vec3 v) {
    float NdotV = clamp(dot(s.normal, v), 0.0, 1.0);
    vec3 light = domelight_specular(lookup_direction(s.normal, v, s.roughness), s.roughness);
    return shade_metallic_roughness(s, NdotV, light, light);
}
