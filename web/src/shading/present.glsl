// The picture on the screen: one pane, or two beside each other; or a map of their difference. Behind tonemap.glsl.

uniform sampler2D u_left;
uniform sampler2D u_right;
uniform sampler2D u_map;    // of the difference, in display values
uniform float u_divider;    // 0 to 1: left of it is u_left
uniform int u_view;         // 0 panes, 1 the map
in vec2 v_point;
out vec4 out_color;

void main() {
    if (u_view == 1) {
        out_color = vec4(texture(u_map, vec2(v_point.x, 1.0 - v_point.y)).rgb, 1.0);
        return;
    }
    vec3 radiance = v_point.x < u_divider ? texture(u_left, v_point).rgb : texture(u_right, v_point).rgb;
    out_color = vec4(displayed(radiance), 1.0);
}
