// The sharp environment by the texture that the user chose: the techniques of reflection mapping. Behind environment.glsl,
// projections.glsl and docs/shaders/generic.glsl.

uniform int u_lookup;  // 0 the environment as it was read, 1 cube, 2 lat-long, 3 sphere map, 4 dual paraboloid
uniform sampler2D u_lookup_map;   // of lookups 2 to 4; of the dual paraboloid its front
uniform sampler2D u_lookup_back;

vec3 mapped_light(vec3 direction) {
    vec3 d = normalize(direction);
    if (u_lookup == 0) return environment_light(d);
    if (u_lookup == 1) return textureLod(u_specular, u_environment * d, 0.0).rgb;
    // These maps show the light as it lies in its own frame.
    d = u_turn * d;
    if (u_lookup == 2) return textureLod(u_lookup_map, latlong_point(d), 0.0).rgb;
    if (u_lookup == 3) return textureLod(u_lookup_map, sphere_map_uv(d), 0.0).rgb;
    return d.z < 0.0 ? textureLod(u_lookup_back, paraboloid_uv(true, d), 0.0).rgb : textureLod(u_lookup_map, paraboloid_uv(false, d), 0.0).rgb;
}
