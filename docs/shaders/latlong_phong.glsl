// Modified Phong, rho_d / pi + rho_s (n_s + 2) / (2 pi) cos^n_s, by two prefiltered lat-long maps. GLSL 3.30 and later,
// and ES 3.00; behind spherical_envmap.glsl.
// Reads what `domelight bake studio.hdr -o out --layout latlong --lobe phong` writes:
//
//   specular.ktx2      u_phong         lat-long; level 0 is the environment itself, the exponents n_s of the others are
//                                      in manifest.json (specular.levels[].exponent) and in the file's key
//                                      domelight.exponent: 2048, 512, 128, 32, 8, 2, 1 where --exponents was not given
//   irradiance.ktx2    u_irradiance    lat-long map of the irradiance E
//
// Linear filtering, between levels too; repeating in s and clamped in t.

uniform sampler2D u_phong;
uniform sampler2D u_irradiance;

/// The level whose lobe has the exponent n_s >= 1; between two levels where it lies between theirs.
float domelight_phong_level(float n_s) {
    if (n_s > 2048.0) return pow(2050.0 / (n_s + 2.0), 0.25);  // level 0 is infinitely sharp
    return max(6.5 - 0.5 * log2(n_s), 7.0 - log2(n_s));
}

/// Its inverse, for level > 0: the exponent of a level.
float domelight_phong_exponent(float level) {
    if (level < 1.0) return 2050.0 / pow(level, 4.0) - 2.0;
    return max(1.0, max(exp2(13.0 - 2.0 * level), exp2(7.0 - level)));
}

/// Light from all around, seen along -v. Vectors of the world, of unit length.
vec3 domelight_shade_phong(vec3 n, vec3 v, vec3 rho_d, vec3 rho_s, float n_s) {
    vec3 irradiance = textureLod(u_irradiance, domelight_latlong_point(n), 0.0).rgb;
    vec3 reflected = textureLod(u_phong, domelight_latlong_point(reflect(-v, n)), domelight_phong_level(n_s)).rgb;
    return rho_d * irradiance / k_pi + rho_s * reflected;
}
