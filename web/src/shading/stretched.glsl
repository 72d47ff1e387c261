// One step beyond split-sum: the lobe is stretched like that of the BRDF, by up to eight more lookups in the same chain
// (docs/math/split-sum.md, "One step beyond"). The C++ is src/render/shading/shading_stretched.cpp and stretched_lobe.cpp. Behind
// metallic_roughness.glsl and the text of render/stretched_fit.ts, which declares k_taps and stretched_fit().

/// max(x, least) with a rounded corner.
float smooth_max(float x, float least) {
    float above = x - least, corner = 0.05 * least;
    return least + 0.5 * (above + sqrt(above * above + corner * corner));
}

vec3 shade(Surface s, vec3 v) {
    float NdotV = clamp(dot(s.normal, v), 0.0, 1.0), roughness = s.roughness;
    vec3 r = reflect(-v, s.normal), across = r - s.normal * dot(s.normal, r);
    float sine = length(across);
    // From r towards n, in the plane of both.
    vec3 up = sine > 0.0 ? s.normal * sine - across * (dot(s.normal, r) / sine) : vec3(0.0);
    float width = 2.0 * roughness * roughness * sqrt(1.0 - NdotV * NdotV);
    float least = clamp(10.0 * roughness - 1.0, 0.0, 1.0) / 6.0;
    float above = clamp(10.0 * NdotV - 9.0, 0.0, 1.0), settled = above * above * clamp(4.0 - 10.0 * roughness, 0.0, 1.0);
    vec3 scale_light = vec3(0.0), bias_light = vec3(0.0);
    float scale_sum = 0.0, bias_sum = 0.0;
    vec4 fits[k_taps];
    stretched_fit(sqrt(NdotV), roughness, fits);
    for (int t = 0; t < k_taps; ++t) {
        vec4 fit = fits[t];
        float tilt = clamp(width * fit.x, -1.7, 1.7);
        float fitted = min(smooth_max(roughness * fit.y, least), 1.0);
        vec3 light = domelight_specular(r * cos(tilt) + up * sin(tilt), mix(fitted, roughness, settled));
        float scale = exp(fit.z), bias = exp(fit.w);
        scale_light += light * scale;
        bias_light += light * bias;
        scale_sum += scale;
        bias_sum += bias;
    }
    return shade_metallic_roughness(s, NdotV, scale_light / scale_sum, bias_light / bias_sum);
}
