// Probes have a GGX chain: a Phong lobe is that of the matching roughness. The C++ is src/render/shading/probe_light.cpp. Behind probe_light.glsl, before phong.glsl.

float matching_roughness(float exponent);

vec3 phong_light(vec3 r, float exponent) {
    return domelight_specular(r, matching_roughness(exponent));
}
