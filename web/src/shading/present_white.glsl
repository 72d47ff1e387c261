// On a screen whose brightest is white. Behind present.glsl.

in vec2 v_point;
out vec4 out_color;

vec3 on_screen(vec3 radiance) {
    return displayed(radiance);
}

void main() {
    out_color = vec4(shown(v_point), 1.0);
}
