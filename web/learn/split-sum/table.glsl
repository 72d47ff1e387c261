// The BRDF table by samples, and the two lobes on the hemisphere. Behind web/src/shading/monte_carlo.glsl.

uniform int u_what;      // 0 the table, 1 the table as a picture, 2 the true lobe from above, 3 the map's
uniform int u_count;
uniform float u_cosine;  // n v of the lobes
uniform float u_lobe_roughness;
in vec2 v_point;
out vec4 out_color;

/// (A, B) by samples of the GGX distribution of normals: Karis 2013, with the height-correlated masking of Heitz 2014.
vec2 integrate_brdf(float NdotV, float roughness, int count) {
    float a2 = pow(roughness, 4.0);
    vec3 v = vec3(sqrt(1.0 - NdotV * NdotV), 0.0, NdotV);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < count; ++i) {
        vec2 random = hammersley(i, count);
        float phi = 2.0 * k_pi * random.x;
        float NdotH = sqrt((1.0 - random.y) / (1.0 + (a2 - 1.0) * random.y));
        float side = sqrt(1.0 - NdotH * NdotH);
        vec3 h = vec3(side * cos(phi), side * sin(phi), NdotH);
        float VdotH = dot(v, h);
        vec3 l = 2.0 * VdotH * h - v;
        if (l.z <= 0.0 || VdotH <= 0.0) continue;
        // G / (n v) = 4 (n l) V, where V is the visibility.
        float V = 0.5 / (l.z * ggx_root(v.z, a2) + v.z * ggx_root(l.z, a2));
        float fc = pow(1.0 - VdotH, 5.0);
        sum += 4.0 * l.z * V * VdotH / NdotH * vec2(1.0 - fc, fc);
    }
    return sum / float(count);
}

/// The true lobe, f cos θ, of white metal.
float true_lobe(vec3 v, vec3 l) {
    Surface s;
    s.diffuse = s.dielectric_f0 = s.dielectric_f90 = vec3(0.0);
    s.f0 = s.f90 = vec3(1.0);
    s.roughness = u_lobe_roughness;
    return brdf_cosine(s, v, l, 0.0).g;
}
/// The lobe of the map about r, under n = v = r.
float map_lobe(vec3 r, vec3 l) {
    float c = dot(r, l), a2 = pow(u_lobe_roughness, 4.0), d = a2 * (1.0 + c) + 1.0 - c;
    return max(c, 0.0) / (d * d);
}

void main() {
    if (u_what <= 1) {
        vec2 scale_bias = integrate_brdf(v_point.x, v_point.y, u_count);
        out_color = vec4(u_what == 0 ? scale_bias : sqrt(scale_bias), 0.0, 1.0);
        return;
    }
    vec2 p = 2.04 * (v_point - 0.5);
    if (dot(p, p) > 1.0) {
        out_color = vec4(0.0);
        return;
    }
    vec3 v = vec3(-sqrt(1.0 - u_cosine * u_cosine), 0.0, u_cosine), r = vec3(-v.xy, v.z), l = vec3(p, sqrt(1.0 - dot(p, p)));
    float peak = map_lobe(r, r);
    if (u_what == 2) {
        peak = 0.0;
        for (int i = 0; i < 256; ++i) {
            float angle = (float(i) + 0.5) / 256.0 * 0.5 * k_pi;
            peak = max(peak, true_lobe(v, vec3(sin(angle), 0.0, cos(angle))));
        }
    }
    float part = (u_what == 2 ? true_lobe(v, l) : map_lobe(r, l)) / peak;
    vec3 color = part > 0.5 ? vec3(1.0, 0.85, 0.4) : part > 0.1 ? vec3(0.85, 0.35, 0.3) : part > 0.01 ? vec3(0.4, 0.15, 0.4) : vec3(0.12, 0.12, 0.16);
    out_color = vec4(color, 1.0);
}
