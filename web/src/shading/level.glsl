// One level of a map as a picture: as a ball, as six faces, or as a lat-long map. Behind environment.glsl, docs/shaders/generic.glsl,
// projections.glsl and tonemap.glsl.

uniform samplerCube u_cube;
uniform float u_level;
uniform float u_scale;     // 1 / pi for the irradiance
uniform bool u_by_harmonics;
uniform int u_shape;       // 0 ball, 1 faces, 2 lat-long
in vec2 v_point;
out vec4 out_color;

vec3 light_of(vec3 d) {
    return u_by_harmonics ? domelight_diffuse_sh(d) : textureLod(u_cube, u_environment * d, u_level).rgb * u_scale;
}

void main() {
    vec2 p = vec2(v_point.x, 1.0 - v_point.y);
    float cover = 1.0;
    vec3 d;
    if (u_shape == 0) {
        // A mirror ball, seen from +Z.
        vec2 q = 2.0 * v_point - 1.0;
        float r2 = dot(q, q), width = fwidth(r2);
        cover = 1.0 - smoothstep(1.0 - width, 1.0, r2);
        vec3 n = vec3(q, sqrt(max(0.0, 1.0 - r2)));
        d = reflect(vec3(0.0, 0.0, -1.0), n);
    } else if (u_shape == 1) {
        d = faces_direction(p);
    } else {
        float phi = (p.x - 0.5) * k_turn, theta = p.y * 0.5 * k_turn;
        d = vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
    }
    out_color = vec4(displayed(light_of(d)), cover);
}
