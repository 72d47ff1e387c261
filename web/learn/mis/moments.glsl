// How much estimates by each strategy vary: integrals, so that directions which a strategy finds once in a million times are not missing. Behind monte_carlo.glsl and
// white_metal.glsl.

uniform vec3 u_normal;
uniform float u_columns_of_table;
uniform int u_directions;  // of each pixel, by each of three densities
in vec2 v_point;
out vec4 out_color;

struct Moments {
    float brdf;         // ∫ g²/p_b dω, with the luminance g of f L cos θ
    float environment;  // ∫ g²/p_a dω
    float both;         // ∫ g²/(p_a + p_b) dω
    vec2 parts;         // ∫ g p_a/(p_a + p_b) dω and ∫ g p_b/(p_a + p_b) dω: together the light itself
};

/// Adds a direction that was drawn by one of three densities, whose sum is q: its part of each integral, over q.
void add_direction(inout Moments m, vec3 f_cosine, EnvmapSample light, float pb, float q) {
    float pa = light.pdf_solid_angle, g = dot(f_cosine * light.radiance, vec3(0.2126, 0.7152, 0.0722));
    if (!(g > 0.0 && pa > 0.0 && pb > 0.0)) return;
    m.brdf += g * g / pb / q;
    m.environment += g * g / pa / q;
    m.both += g * g / (pa + pb) / q;
    m.parts += g * vec2(pa, pb) / (pa + pb) / q;
}

/// The third density: a direction of the environment's strategy, moved to one of the nine texels around it. Beside a small lamp, light that is bilinear between texels is bright where
/// the density is that of a dark texel, and neither strategy goes there.
float moved_pdf(vec2 point) {
    ivec2 size = textureSize(u_envmap, 0), texel = min(ivec2(point * vec2(size)), size - 1);
    float sum = 0.0;
    for (int k = 0; k < 9; ++k) {
        ivec2 from = texel + ivec2(k % 3, k / 3) - 1;
        if (from.y >= 0 && from.y < size.y) sum += envmapWeight((from.x + size.x) % size.x, from.y, size.y);
    }
    return sum / 9.0 / u_total_average / (2.0 * k_pi * k_pi * max(sin(k_pi * point.y), 1e-7));
}

Moments integrate_moments(Surface s, vec3 view, int count) {
    mat3 frame = frame_of(s.normal);
    vec3 v = view * frame;
    float share = specular_share(s, v.z);
    vec2 texel = 1.0 / vec2(textureSize(u_envmap, 0));
    Moments m = Moments(0.0, 0.0, 0.0, vec2(0.0));
    for (int i = 0; i < 3 * count; ++i) {
        vec4 random = random4();
        vec3 direction = i % 3 == 1 ? frame * sample_brdf(s, share, v, random) : sample_guided(random.xy).direction;
        if (i % 3 == 2) {
            vec2 moved = domelight_latlong_point(direction) + texel * (floor(3.0 * random.zw) - 1.0);
            if (moved.y < 0.0 || moved.y > 1.0) continue;
            direction = domelight_latlong_direction(vec2(fract(moved.x), moved.y));
        }
        EnvmapSample light = look_up(direction);
        vec3 l = direction * frame;
        float pb = brdf_pdf(s, share, v, l);
        add_direction(m, brdf_cosine(s, v, l, 0.0), light, pb, light.pdf_solid_angle + pb + moved_pdf(domelight_latlong_point(direction)));
    }
    return m;
}

/// Rows 0, 2, 4, ...: the three second moments. Rows 1, 3, 5, ...: the parts.
void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    g_seed = uvec4(place.x, place.y / 2, 7u, 0u);
    Moments m = integrate_moments(white_metal(u_normal, gl_FragCoord.x / u_columns_of_table), vec3(0.0, 0.0, 1.0), u_directions);
    out_color = (place.y % 2 == 0 ? vec4(m.brdf, m.environment, m.both, 0.0) : vec4(m.parts, 0.0, 0.0)) / float(u_directions);
}
