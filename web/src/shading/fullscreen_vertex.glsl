// A triangle that covers the picture.

out vec2 v_point;  // 0 to 1, y up

void main() {
    vec2 p = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    gl_Position = vec4(p, 0.0, 1.0);
    v_point = 0.5 * p + 0.5;
}
