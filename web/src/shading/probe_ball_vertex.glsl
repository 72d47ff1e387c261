// A small ball where each probe stands: one instance of a sphere each.

in vec3 position;
in vec3 centre;
in float kind;

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform float u_ball_radius;

out vec3 v_normal;
out vec3 v_position;
flat out int v_probe;
flat out int v_kind;

void main() {
    v_normal = position;
    v_position = centre + u_ball_radius * position;
    v_probe = gl_InstanceID;
    v_kind = int(kind);
    gl_Position = projectionMatrix * viewMatrix * vec4(v_position, 1.0);
}
