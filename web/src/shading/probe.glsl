// The normal and the roughness of one point, for the lobe under the pointer. Behind surface.glsl.

out vec4 out_color;

void main() {
    Surface s = surface_here();
    out_color = vec4(s.normal, s.roughness);
}
