// Runs the loops of docs/shaders/sample_envmap.glsl for numbers of a table.

uniform vec2 u_random;
uniform int u_count;
uniform int u_what;  // 0 the direction and density of u_random, 1 of point i of u_count, 2 diffuseBySamples with 1, 2, 4, ... samples
in vec2 v_point;
out vec4 out_color;

void main() {
    int i = int(gl_FragCoord.x);
    if (u_what == 2) {
        out_color = vec4(diffuseBySamples(vec3(0.0, 1.0, 0.0), 1 << i), 1.0);
        return;
    }
    EnvmapSample light = sampleEnvmap(u_what == 0 ? u_random : hammersley(i, u_count));
    out_color = vec4(light.direction, light.pdf_solid_angle);
}
