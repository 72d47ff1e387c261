// A triangle that covers the picture, behind everything.

uniform mat4 u_unproject;  // from clip space to directions of the world
out vec3 v_direction;

void main() {
    vec2 p = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    gl_Position = vec4(p, 1.0, 1.0);
    v_direction = (u_unproject * vec4(p, 1.0, 1.0)).xyz;
}
