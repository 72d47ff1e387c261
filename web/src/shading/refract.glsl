// Refraction mapping: the sharp environment in the direction refracted once, at the front surface, mixed with the reflection by
// Schlick's Fresnel term (1994, eq. 15). The C++ is src/render/shading/shading_refract.cpp. Behind lookup.glsl.

uniform float u_ior_outside;  // of what surrounds the model: 1 for air
uniform float u_ior_inside;   // below 0: the material's

float highlight_f0(Surface s) {
    float inside = u_ior_inside > 0.0 ? u_ior_inside : s.ior, ratio = (inside - 1.0) / (inside + 1.0);
    return ratio * ratio;
}

vec3 shade(Surface s, vec3 v) {
    float inside = u_ior_inside > 0.0 ? u_ior_inside : s.ior, outside = u_ior_outside, NdotV = clamp(dot(s.normal, v), 0.0, 1.0);
    float eta = s.front ? outside / inside : inside / outside;
    // Snell: sin t = eta sin i; beyond the critical angle all is reflected.
    float cos2 = 1.0 - eta * eta * (1.0 - NdotV * NdotV);
    float ratio = (inside - outside) / (inside + outside), f0 = ratio * ratio;
    float mirrored = cos2 > 0.0 ? f0 + (1.0 - f0) * pow(1.0 - NdotV, 5.0) : 1.0;
    vec3 light = mapped_light(reflect(-v, s.normal)) * mirrored;
    if (mirrored < 1.0) light += mapped_light(s.normal * (eta * NdotV - sqrt(cos2)) - v * eta) * (1.0 - mirrored);
    return light;
}
