// From linear radiance to the values of a display. The C++ is src/preview/tonemap.cpp and agx.h.

uniform int u_tonemap;  // 0 none, 1 Reinhard, 2 ACES, 3 AgX, 4 Khronos neutral
uniform float u_exposure;

float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

/// Reinhard et al. 2002, eq. 4, on luminance: the luminance 4 becomes white.
vec3 tonemap_reinhard(vec3 v) {
    float l = luminance(v);
    return v * ((1.0 + l / 16.0) / (1.0 + l));
}

vec3 aces_curve(vec3 x) {
    return (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
}

/// ACES 1.0's reference rendering and sRGB output transforms, by S. Hill's fit.
vec3 tonemap_aces(vec3 v) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 from = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    return from * aces_curve(min(into * v, vec3(1e15)));
}

/// AgX (Sobotka 2022), the curve by B. Wrensch's polynomial; display values of gamma 2.2 become linear again.
vec3 tonemap_agx(vec3 v) {
    const mat3 into = mat3(0.842479062, 0.0423282422, 0.0423756549, 0.0784336, 0.878468636, 0.0784336, 0.0792237451,
                           0.0791661275, 0.879142974);
    const mat3 from = mat3(1.196879005, -0.0528968518, -0.0529716355, -0.0980208811, 1.15190313, -0.0980434501,
                           -0.0990297441, -0.0989611768, 1.15107367);
    vec3 ev = log2(max(into * v, vec3(1e-10)));
    vec3 x = clamp((ev + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
    vec3 x2 = x * x, x4 = x2 * x2;
    vec3 y = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return pow(clamp(from * y, 0.0, 1.0), vec3(2.2));
}

/// Khronos PBR Neutral, 2024.
vec3 tonemap_neutral(vec3 v) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float least = min(v.r, min(v.g, v.b));
    v -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(v.r, max(v.g, v.b));
    if (peak < start) return v;
    const float d = 1.0 - start;
    float new_peak = 1.0 - d * d / (peak + d - start);
    v *= new_peak / peak;
    float g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(v, vec3(new_peak), g);
}

vec3 srgb_encode(vec3 c) {
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
}

/// The chosen curve: linear radiance times the exposure to linear light of the screen, of which 1 is white. Without a curve and by Reinhard's,
/// more than 1 is possible.
vec3 tonemapped(vec3 v) {
    return u_tonemap == 1   ? tonemap_reinhard(v)
           : u_tonemap == 2 ? tonemap_aces(v)
           : u_tonemap == 3 ? tonemap_agx(v)
           : u_tonemap == 4 ? tonemap_neutral(v)
                            : v;
}

/// Linear radiance to sRGB values, 0 to 1.
vec3 displayed(vec3 radiance) {
    return srgb_encode(clamp(tonemapped(max(radiance * u_exposure, 0.0)), 0.0, 1.0));
}
