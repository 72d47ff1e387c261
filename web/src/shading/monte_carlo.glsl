// The reflected light itself, by random samples, which the panes average: the integral of f L cos over the hemisphere, without shadows, as
// `domelight render --shading reference --bounces 0 --occlusion off` computes it. Behind brdf.glsl, docs/shaders/spherical_envmap.glsl and
// sample_envmap.glsl, whose loops over row averages and along a row draw from the environment, and bilinear.glsl.

uniform int u_strategy;    // 0 both (MIS), 1 the environment, 2 the BRDF
uniform int u_tables;      // 0 the loops, 1 guide tables
uniform int u_samples;     // of each frame
uniform int u_frame;
uniform sampler2D u_columns;  // R: cumulative weight of a row up to and with a column, 0 to 1. G: where to begin for a random number
uniform sampler2D u_rows;     // the same of the rows, 1 wide

// Random numbers: Jarzynski and Olano 2020, "Hash functions for GPU rendering", pcg4d.
uvec4 g_seed;
vec4 random4() {
    uvec4 v = g_seed * 1664525u + 1013904223u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w; v.y += v.z * v.x; v.z += v.x * v.y; v.w += v.y * v.z;
    g_seed.z += 1u;
    return vec4(v >> 8u) / 16777216.0;
}

/// Radiance at a point of the map, bilinear between texels: what all strategies integrate. (The densities are constant in each texel.)
vec3 radiance_at(vec2 point) {
    return bilinear(u_envmap, point);
}

/// A direction by inversion of the two cumulative functions. The guide says for each cell of random numbers where its search begins.
EnvmapSample sample_guided(vec2 random) {
    ivec2 size = textureSize(u_envmap, 0);
    int row = int(texelFetch(u_rows, ivec2(0, int(random.y * float(size.y))), 0).g);
    while (row < size.y - 1 && texelFetch(u_rows, ivec2(0, row), 0).r <= random.y) ++row;
    float below = row > 0 ? texelFetch(u_rows, ivec2(0, row - 1), 0).r : 0.0, above = texelFetch(u_rows, ivec2(0, row), 0).r;
    float y = (float(row) + clamp((random.y - below) / (above - below), 0.0, 0.999999)) / float(size.y);

    int column = int(texelFetch(u_columns, ivec2(int(random.x * float(size.x)), row), 0).g);
    while (column < size.x - 1 && texelFetch(u_columns, ivec2(column, row), 0).r <= random.x) ++column;
    float left = column > 0 ? texelFetch(u_columns, ivec2(column - 1, row), 0).r : 0.0, right = texelFetch(u_columns, ivec2(column, row), 0).r;
    float x = (float(column) + clamp((random.x - left) / (right - left), 0.0, 0.999999)) / float(size.x);

    EnvmapSample light;
    light.direction = domelight_latlong_direction(vec2(x, y));
    light.radiance = radiance_at(vec2(x, y));
    light.pdf_solid_angle = envmapWeight(column, row, size.y) / u_total_average / (2.0 * k_pi * k_pi * max(sin(k_pi * y), 1e-7));
    return light;
}

/// Radiance of a direction and the density with which the environment's strategy draws it.
EnvmapSample look_up(vec3 direction) {
    ivec2 size = textureSize(u_envmap, 0);
    vec2 p = domelight_latlong_point(direction);
    ivec2 texel = min(ivec2(p * vec2(size)), size - 1);
    EnvmapSample light;
    light.direction = direction;
    light.radiance = radiance_at(p);
    light.pdf_solid_angle = envmapWeight(texel.x, texel.y, size.y) / u_total_average / (2.0 * k_pi * k_pi * max(sin(k_pi * p.y), 1e-7));
    return light;
}

/// The part of the samples that is drawn from the specular lobe.
float specular_share(Surface s, float NdotV) {
    const vec3 weights = vec3(0.2126, 0.7152, 0.0722);
    float gloss = dot(mix(s.f0, s.f90, pow(1.0 - NdotV, 5.0)), weights), matt = dot(s.diffuse, weights);
    return matt <= 0.0 ? 1.0 : clamp(gloss / (gloss + matt), 0.2, 0.9);
}
/// Visible normals: Heitz 2018, the density G1 D / (4 NdotV) of the reflected direction.
float brdf_pdf(Surface s, float share, vec3 v, vec3 l) {
    if (l.z <= 0.0) return 0.0;
    float a2 = pow(s.roughness, 4.0);
    return share * ggx_d(v + l, a2) / (2.0 * (v.z + ggx_root(v.z, a2))) + (1.0 - share) * l.z / k_pi;
}
vec3 sample_brdf(Surface s, float share, vec3 v, vec4 random) {
    float phi = 2.0 * k_pi * random.y;
    if (random.z >= share) {
        float r = sqrt(random.x);
        return vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - random.x));
    }
    // A normal by a spherical cap: Dupuy and Benyoub 2023.
    float alpha = s.roughness * s.roughness;
    vec3 axis = normalize(vec3(alpha * v.xy, v.z));
    float q = random.x * (1.0 + axis.z), radius = sqrt(q * (2.0 - q));
    vec3 h = normalize(vec3(alpha * (axis.xy + radius * vec2(cos(phi), sin(phi))), axis.z + (1.0 - q)));
    return reflect(-v, h);
}

vec3 shade(Surface s, vec3 view) {
    g_seed = uvec4(uvec2(gl_FragCoord.xy), 0u, uint(u_frame));
    mat3 frame = frame_of(s.normal);
    vec3 v = view * frame, sum = vec3(0.0);
    float share = specular_share(s, v.z);
    for (int i = 0; i < u_samples; ++i) {
        vec4 random = random4();
        if (u_strategy != 2) {
            EnvmapSample light;
            if (u_tables == 1) {
                light = sample_guided(random.xy);
            } else {
                light = sampleEnvmap(random.xy);
                light.radiance = radiance_at(domelight_latlong_point(light.direction));
            }
            vec3 l = light.direction * frame;
            // The balance heuristic of one sample each: Veach 1997, eq. 9.8.
            float pdf = light.pdf_solid_angle + (u_strategy == 0 ? brdf_pdf(s, share, v, l) : 0.0);
            if (light.pdf_solid_angle > 0.0) sum += brdf_cosine(s, v, l, 0.0) * light.radiance / pdf;
        }
        if (u_strategy != 1) {
            vec3 l = sample_brdf(s, share, v, random4());
            EnvmapSample light = look_up(frame * l);
            float pdf = brdf_pdf(s, share, v, l) + (u_strategy == 0 ? light.pdf_solid_angle : 0.0);
            if (l.z > 0.0 && pdf > 0.0) sum += brdf_cosine(s, v, l, 0.0) * light.radiance / pdf;
        }
    }
    return sum / float(u_samples);
}
