// A map as the screen shows it, darker where a normal does not look. Behind map.glsl.

uniform vec3 u_facing;  // of length 0: everything is as bright as it is
uniform float u_scale;
in vec2 v_point;
out vec4 out_color;

void main() {
    vec3 d = latlong_direction(vec2(v_point.x, 1.0 - v_point.y));
    float part = dot(d, u_facing) < 0.0 ? 0.3 : 1.0;
    out_color = vec4(displayed(radiance_from(d) * u_scale) * part, 1.0);
}
