// How much estimates by each strategy vary: integrals, so that directions which a strategy finds once in a million times are not missing. Behind monte_carlo.glsl and
// white_metal.glsl.

uniform vec3 u_normal;
uniform float u_columns_of_table;
uniform int u_directions;  // of each pixel and strategy
in vec2 v_point;
out vec4 out_color;

struct Moments {
    float brdf;         // ∫ g²/p_b dω, with the luminance g of f L cos θ
    float environment;  // ∫ g²/p_a dω
    float both;         // ∫ g²/(p_a + p_b) dω
    vec2 parts;         // ∫ g p_a/(p_a + p_b) dω and ∫ g p_b/(p_a + p_b) dω: together the light itself
};

/// Adds a direction that was drawn with p_a or p_b: its part of each integral, over p_a + p_b.
void add_direction(inout Moments m, vec3 f_cosine, EnvmapSample light, float pb) {
    float pa = light.pdf_solid_angle, g = dot(f_cosine * light.radiance, vec3(0.2126, 0.7152, 0.0722)), q = pa + pb;
    if (!(g > 0.0 && pa > 0.0 && pb > 0.0)) return;
    m.brdf += g * g / pb / q;
    m.environment += g * g / pa / q;
    m.both += g * g / q / q;
    m.parts += g * vec2(pa, pb) / q / q;
}

Moments integrate_moments(Surface s, vec3 view, int count) {
    mat3 frame = frame_of(s.normal);
    vec3 v = view * frame;
    float share = specular_share(s, v.z);
    Moments m = Moments(0.0, 0.0, 0.0, vec2(0.0));
    for (int i = 0; i < count; ++i) {
        EnvmapSample light = sample_guided(random4().xy);
        vec3 l = light.direction * frame;
        add_direction(m, brdf_cosine(s, v, l, 0.0), light, brdf_pdf(s, share, v, l));
        l = sample_brdf(s, share, v, random4());
        add_direction(m, brdf_cosine(s, v, l, 0.0), look_up(frame * l), brdf_pdf(s, share, v, l));
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
