// What is seen where no surface is. Behind environment.glsl and docs/shaders/generic.glsl.

uniform int u_background;  // 0 the environment, 1 blurred, 2 a plain colour
uniform vec3 u_background_color;
uniform float u_background_roughness;
in vec3 v_direction;
out vec4 out_color;

void main() {
    vec3 d = normalize(v_direction);
    vec3 light = u_background == 0 ? environment_light(d)
               : u_background == 1 ? domelight_specular(d, u_background_roughness)
                                   : u_background_color;
    out_color = vec4(min(light, vec3(65504.0)), 1.0);
}
