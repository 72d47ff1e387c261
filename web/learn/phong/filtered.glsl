// The light of a Phong lobe by the levels of a chain, and the lobe itself over the map. Behind learn/common/map.glsl, docs/shaders/generic.glsl,
// and web/src/shading: material.glsl, diffuse.glsl, phong.glsl.

uniform vec3 u_mirror;
uniform int u_what;  // 0 the map with the lobe, 1 the filtered map, 2 the filtered light of u_mirror, 3 the same for exponents that grow from column to column
in vec2 v_point;
out vec4 out_color;

/// The lobe with its cosine, as a density per steradian.
float phong_lobe(float cosine, float exponent) {
    return (exponent + 2.0) / k_turn * pow(max(cosine, 0.0), exponent + 1.0);
}

void main() {
    vec3 d = latlong_direction(vec2(v_point.x, 1.0 - v_point.y));
    if (u_what == 0) {
        float part = phong_lobe(dot(d, u_mirror), u_exponent) / phong_lobe(1.0, u_exponent);
        out_color = vec4(mix(displayed(radiance_from(d)), vec3(1.0, 0.31, 0.85), 0.8 * part), 1.0);
    } else if (u_what == 1) {
        out_color = vec4(displayed(phong_light(d, u_exponent)), 1.0);
    } else {
        out_color = vec4(phong_light(u_mirror, u_what == 2 ? u_exponent : exp2(0.25 * floor(gl_FragCoord.x))), 1.0);
    }
}
