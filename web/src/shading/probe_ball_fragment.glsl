// The irradiance over pi that a probe holds, on a ball with a rim that says what the probe is. Behind probe_records.glsl.

in vec3 v_normal;
in vec3 v_position;
flat in int v_probe;
flat in int v_kind;  // 0 where it was placed, 1 moved, 2 not valid

uniform vec3 u_eye;
uniform float u_ball_white;  // the radiance that the screen shows as white
out vec4 out_color;

void main() {
    vec3 n = normalize(v_normal);
    float NdotV = dot(n, normalize(u_eye - v_position));
    vec3 rim = v_kind == 0 ? vec3(0.9) : v_kind == 1 ? vec3(1.0, 0.4, 0.0) : vec3(0.9, 0.05, 0.5);
    // One that is not valid is also crossed out, for whom the colours are alike.
    bool crossed = v_kind == 2 && min(abs(n.x + n.z), abs(n.x - n.z)) < 0.2;
    vec3 light = crossed ? vec3(0.0) : probe_diffuse(v_probe, face_point(n));
    out_color = vec4(NdotV < 0.55 ? rim * u_ball_white : min(light, vec3(65504.0)), 1.0);
}
