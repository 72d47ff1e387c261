// The irradiance of a plane as a Riemann sum. Behind learn/common/map.glsl.

uniform vec3 u_normal;
uniform int u_k;     // steps of φ, around the normal
uniform int u_j;     // steps of θ, from the normal to the horizon
uniform int u_what;  // 0 a lat-long map of E / π, 1 a table of E, 2 the directions of the sum
in vec2 v_point;
out vec4 out_color;

/// The middle of step (k, j) of K x J, as a direction of the world.
vec3 step_direction(vec3 n, int k, int j, int K, int J) {
    vec3 side = abs(n.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 t = normalize(cross(side, n)), b = cross(n, t);
    float phi = (float(k) + 0.5) / float(K) * k_turn;
    float theta = (float(j) + 0.5) / float(J) * 0.25 * k_turn;
    return sin(theta) * (cos(phi) * t + sin(phi) * b) + cos(theta) * n;
}

/// E(n) = ∫ L cos θ dω, with dω = sin θ dθ dφ.
vec3 irradiance_sum(vec3 n, int K, int J) {
    float d_phi = k_turn / float(K), d_theta = 0.25 * k_turn / float(J);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < J; ++j) {
        float theta = (float(j) + 0.5) * d_theta;
        for (int k = 0; k < K; ++k)
            sum += radiance_from(step_direction(n, k, j, K, J))
                   * cos(theta) * sin(theta);
    }
    return sum * d_phi * d_theta;
}

void main() {
    int i = int(gl_FragCoord.x);
    if (u_what == 0) {
        vec3 n = latlong_direction(vec2(v_point.x, 1.0 - v_point.y));
        out_color = vec4(displayed(irradiance_sum(n, u_k, u_j) * 2.0 / k_turn), 1.0);
    } else if (u_what == 1) {
        // First what the user chose, then J = 1, 2, 4, ... with K = 4 J.
        int J = i == 0 ? u_j : 1 << (i - 1);
        out_color = vec4(irradiance_sum(u_normal, i == 0 ? u_k : 4 * J, J), 1.0);
    } else {
        out_color = vec4(step_direction(u_normal, i, int(gl_FragCoord.y), u_k, u_j), 1.0);
    }
}
