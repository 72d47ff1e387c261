// The end of every shader of a model: the radiance of the surface, of whichever method came before.

out vec4 out_color;

void main() {
    Surface s = surface_here();
#ifdef LIGHT_BY_PROBES
    blend_at(s.position, s.normal);
#endif
    vec3 light = s.emission;
    vec3 v = normalize(u_eye - s.position);
    if (!s.unlit) light += shade(s, v) + shade_lights(s, v);
    // Beyond this a half float is infinite.
    out_color = vec4(min(light, vec3(65504.0)), s.opacity);
}
