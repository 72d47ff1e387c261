// A ball of white metal, seen from +Z, by whichever method's shade() came before. Behind web/src/shading/material.glsl and white_metal.glsl.

uniform vec3 u_normal;
uniform float u_ball_roughness;
uniform int u_what;     // 0 the ball, 1 estimates of the point with u_normal
in vec2 v_point;
out vec4 out_color;

void main() {
    const vec3 view = vec3(0.0, 0.0, 1.0);
    if (u_what == 0) {
        vec2 p = 2.06 * (v_point - 0.5);
        float r2 = dot(p, p);
        out_color = r2 > 1.0 ? vec4(0.0) : vec4(shade(white_metal(vec3(p, sqrt(1.0 - r2)), u_ball_roughness), view), 1.0);
    } else {
        out_color = vec4(shade(white_metal(u_normal, u_ball_roughness), view), 1.0);
    }
}
