// The picture on the screen: one pane, or two beside each other; or their difference, or a map of it. Behind tonemap.glsl and heat(), before present_white.glsl or
// present_extended.glsl.

uniform sampler2D u_left;
uniform sampler2D u_right;
uniform sampler2D u_map;    // of FLIP, in display values
uniform float u_divider;    // 0 to 1: left of it is u_left
uniform int u_view;         // 0 panes, 1 the map, 2 the difference of the panes

/// Linear radiance to the screen's values.
vec3 on_screen(vec3 radiance);

/// The screen's values at a point of the picture, 0 to 1, y up.
vec3 shown(vec2 point) {
    if (u_view == 1) return texture(u_map, vec2(point.x, 1.0 - point.y)).rgb;
    if (u_view == 2) {
        vec3 d = displayed(texture(u_left, point).rgb) - displayed(texture(u_right, point).rgb);
        return heat(sqrt(dot(d, d) / 3.0) * 255.0 / 64.0);
    }
    return on_screen(point.x < u_divider ? texture(u_left, point).rgb : texture(u_right, point).rgb);
}
