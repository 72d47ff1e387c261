// A picture of radiance as the screen shows it, or the difference of two. Behind web/src/shading/tonemap.glsl.

uniform sampler2D u_picture;
uniform sampler2D u_other;
uniform bool u_difference;
in vec2 v_point;
out vec4 out_color;

void main() {
    vec4 picture = texture(u_picture, v_point);
    if (u_difference) {
        float here = luminance(picture.rgb) * u_exposure, there = luminance(texture(u_other, v_point).rgb) * u_exposure;
        float d = clamp(4.0 * (here / (1.0 + here) - there / (1.0 + there)), -1.0, 1.0);
        // Red: too bright. Blue: too dark.
        out_color = vec4(d > 0.0 ? vec3(1.0, 1.0 - d, 1.0 - d) : vec3(1.0 + d, 1.0 + d, 1.0), picture.a);
    } else {
        out_color = vec4(displayed(picture.rgb), picture.a);
    }
}
