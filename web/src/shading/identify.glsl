// The number of each object, for errors by object.

uniform float u_object;
out vec4 out_color;

void main() {
    out_color = vec4(mod(u_object, 256.0) / 255.0, floor(u_object / 256.0) / 255.0, 0.0, 1.0);
}
