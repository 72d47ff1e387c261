// Lights of the model that have no size (KHR_lights_punctual), without shadows: the material's own BRDF towards each; under mirror and refract a highlight.
// The C++ is src/render/punctual.h and src/render/shading/shading_lights.cpp. Behind brdf.glsl; LIT_BY says whose light this adds to.

const int k_most_lights = 16;
uniform int u_light_count;
// Of each: position and kind (0 directional, 1 point, 2 spot); the way the light travels and 1 / range; intensity and the cosine of the inner
// cone; the cosine of the outer cone.
uniform vec4 u_lights[4 * k_most_lights];

/// Irradiance perpendicular to the light, of intensity 1: the inverse-square law, the fall to 0 at the range, and the edge of a spot light.
float arrival(int i, vec3 position, out vec3 l) {
    vec4 place = u_lights[4 * i], way = u_lights[4 * i + 1];
    l = -way.xyz;
    if (place.w == 0.0) return 1.0;
    vec3 to = place.xyz - position;
    float squared = dot(to, to), reach = squared * squared * pow(way.w, 4.0);
    l = to * inversesqrt(squared);
    float strength = clamp(1.0 - reach, 0.0, 1.0) / squared;
    if (place.w == 2.0) {
        float inner = u_lights[4 * i + 2].w, outer = u_lights[4 * i + 3].x;
        float edge = clamp((-dot(l, way.xyz) - outer) / max(0.001, inner - outer), 0.0, 1.0);
        strength *= edge * edge;
    }
    return strength;
}

#if LIT_BY == 1
/// Modified Phong, times the cosine.
vec3 lit(Surface s, vec3 v, vec3 l) {
    if (l.z <= 0.0 || v.z <= 0.0) return vec3(0.0);
    float alpha = s.roughness * s.roughness, n = u_exponent > 0.0 ? u_exponent : max(0.0, 2.0 / max(alpha * alpha, 1e-7) - 2.0);
    float cosine = max(0.0, dot(vec3(-v.xy, v.z), l));
    return (s.diffuse / k_pi + s.f0 * ((n + 2.0) / (2.0 * k_pi) * (cosine > 0.0 ? pow(cosine, n) : 0.0))) * l.z;
}
#elif LIT_BY == 2
/// The least roughness that engines give a highlight: a mirror would show a light without size as nothing at all.
vec3 lit(Surface s, vec3 v, vec3 l) {
    s.diffuse = vec3(0.0);
    s.f0 = vec3(highlight_f0(s));
    s.f90 = vec3(1.0);
    s.roughness = 0.045;
    return brdf_cosine(s, v, l, 0.0);
}
#elif LIT_BY == 3
vec3 lit(Surface s, vec3 v, vec3 l) {
    vec2 scale_bias = textureLod(u_brdf, vec2(v.z, s.roughness), 0.0).rg;
    float albedo = scale_bias.x + scale_bias.y;
    return brdf_cosine(s, v, l, u_multiple_scattering ? (1.0 - albedo) / albedo : 0.0);
}
#else
vec3 lit(Surface s, vec3 v, vec3 l) {
    return brdf_cosine(s, v, l, 0.0);
}
#endif

vec3 shade_lights(Surface s, vec3 view) {
    mat3 frame = frame_of(s.normal);
    vec3 v = view * frame, sum = vec3(0.0);
    for (int i = 0; i < u_light_count; ++i) {
        vec3 l;
        float strength = arrival(i, s.position, l);
        if (strength > 0.0) sum += lit(s, v, l * frame) * u_lights[4 * i + 2].rgb * strength;
    }
    return sum;
}
