// Importance sampling of an environment within a shader: light directions in proportion to luminance times sin(theta),
// without cumulative tables. GLSL 3.30 and later, and ES 3.00; behind spherical_envmap.glsl.
//
//   u_envmap           the environment as a lat-long map, first row the top one; only its texels are read
//   u_row_averages     1 wide, as high as the map: R, the average over each row of luminance times sin(theta)
//   u_total_average    the average of that over all rows
//
// `domelight sample small.exr --tables tables --json` writes tables/row_averages.ktx2 (with the weight that --weight has
// by default) and tells tables.total_average, which is also the file's key domelight.total_average. A sample reads up
// to width + height texels, so the map should be small:
// `domelight convert studio.hdr small.exr --to latlong --size 64 --encoding float`.

uniform sampler2D u_envmap;
uniform sampler2D u_row_averages;
uniform float u_total_average;

/// What a texel is drawn in proportion to. Row 0 is the top one. theta is that of the row's centre.
float envmapWeight(int column, int row, int height) {
    float luminance = dot(texelFetch(u_envmap, ivec2(column, row), 0).rgb, vec3(0.2126, 0.7152, 0.0722));
    return luminance * sin(k_pi * (float(row) + 0.5) / float(height));
}

/// A direction of the world in which light was found.
struct EnvmapSample {
    vec3 direction;         // of unit length
    vec3 radiance;          // from there: that of the texel, since the density is constant in each texel
    float pdf_solid_angle;  // density per steradian with which it was drawn
};

/// Draws a direction by a random point of the unit square, [0, 1). Both loops take one weight after the other off what
/// is left of the random number, which was scaled to the sum of all weights, until a weight is larger than the rest;
/// the rest then says where in this row or texel the point lies. A map without any light has no such direction.
EnvmapSample sampleEnvmap(vec2 random) {
    ivec2 size = textureSize(u_envmap, 0);

    // The row, by the averages over the rows.
    int row = 0;
    float average = texelFetch(u_row_averages, ivec2(0, 0), 0).r;
    float rest = random.y * u_total_average * float(size.y);
    while (row < size.y - 1 && rest >= average) {
        rest -= average;
        row++;
        average = texelFetch(u_row_averages, ivec2(0, row), 0).r;
    }
    while (row > 0 && average == 0.0) {  // rounding may lead past the last row that has light
        row--;
        average = texelFetch(u_row_averages, ivec2(0, row), 0).r;
    }
    float y = (float(row) + clamp(rest / average, 0.0, 0.999999)) / float(size.y);

    // Along the row, by its texels.
    int column = 0;
    float weight = envmapWeight(0, row, size.y);
    rest = random.x * average * float(size.x);
    while (column < size.x - 1 && rest >= weight) {
        rest -= weight;
        column++;
        weight = envmapWeight(column, row, size.y);
    }
    while (column > 0 && weight == 0.0) {
        column--;
        weight = envmapWeight(column, row, size.y);
    }
    float x = (float(column) + clamp(rest / weight, 0.0, 0.999999)) / float(size.x);

    // The density over the unit square is weight / total, and d omega = 2 pi^2 sin(theta) dx dy.
    EnvmapSample light;
    light.direction = domelight_latlong_direction(vec2(x, y));
    light.radiance = texelFetch(u_envmap, ivec2(column, row), 0).rgb;
    light.pdf_solid_angle = weight / u_total_average / (2.0 * k_pi * k_pi * max(sin(k_pi * y), 0.0000001));
    return light;
}

/// Point i of n in the unit square: Hammersley's, which are spread more evenly than random ones.
vec2 hammersley(int i, int n) {
    float mirrored = 0.0;
    float digit = 0.5;
    for (int rest = i; rest > 0; rest /= 2) {
        mirrored += digit * float(rest % 2);
        digit *= 0.5;
    }
    return vec2((float(i) + 0.5) / float(n), mirrored + 0.5 / float(n));
}

/// Radiance that leaves a white diffuse surface, the integral of L NdotL / pi, by `count` samples of the light.
vec3 diffuseBySamples(vec3 n, int count) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        EnvmapSample light = sampleEnvmap(hammersley(i, count));
        sum += light.radiance * max(dot(n, light.direction), 0.0) / (k_pi * light.pdf_solid_angle);
    }
    return sum / float(count);
}
