// What a material says of a point: glTF's metallic-roughness model with its textures, KHR_materials_ior, KHR_materials_specular and
// KHR_materials_unlit. The C++ is src/render/surface/surface.cpp, surface_at(). Behind
// material.glsl.

in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
in vec2 v_uv1;
in vec4 v_tangent;
in vec4 v_color;

uniform vec3 u_eye;
uniform vec4 u_base_color;
uniform float u_metalness;
uniform float u_roughness;
uniform vec3 u_emission;
uniform float u_ior;
uniform float u_specular_weight;
uniform vec3 u_specular_tint;
uniform float u_normal_scale;
uniform float u_occlusion_strength;
uniform float u_alpha_cutoff;  // below 0: no cut-out
uniform bool u_blend;
uniform bool u_unlit;
uniform bool u_occlusion;      // whether occlusion textures are read
uniform bool u_override;       // every surface has the material that the user chose:
uniform vec3 u_override_color;
uniform float u_override_metalness;
uniform float u_override_roughness;

#ifdef BASE_COLOR_MAP
uniform sampler2D u_base_color_map;
uniform mat3 u_base_color_map_uv;
#endif
#ifdef METALLIC_ROUGHNESS_MAP
uniform sampler2D u_metallic_roughness_map;
uniform mat3 u_metallic_roughness_map_uv;
#endif
#ifdef NORMAL_MAP
uniform sampler2D u_normal_map;
uniform mat3 u_normal_map_uv;
#endif
#ifdef OCCLUSION_MAP
uniform sampler2D u_occlusion_map;
uniform mat3 u_occlusion_map_uv;
#endif
#ifdef EMISSION_MAP
uniform sampler2D u_emission_map;
uniform mat3 u_emission_map_uv;
#endif

vec2 map_point(mat3 transform, vec2 uv) {
    return (transform * vec3(uv, 1.0)).xy;
}

#ifdef NORMAL_MAP
/// glTF 2.0, 3.9.3: the texture bends the normal in the tangent frame, which is the mesh's or comes from the derivatives.
vec3 mapped_normal(vec3 n, vec2 uv) {
#ifdef HAS_TANGENT
    vec3 t = v_tangent.xyz;
    vec3 b = cross(n, t) * v_tangent.w;
#else
    vec2 du = dFdx(uv), dv = dFdy(uv);
    vec3 px = dFdx(v_position), py = dFdy(v_position);
    float side = sign(du.x * dv.y - du.y * dv.x);
    vec3 t = (px * dv.y - py * du.y) * side;
    vec3 b = (px * dv.x - py * du.x) * side;
#endif
    t = normalize(t - n * dot(n, t));
    b = normalize(b - n * dot(n, b));
    vec3 texel = 2.0 * texture(u_normal_map, uv).xyz - 1.0;
    vec3 bent = t * (texel.x * u_normal_scale) + b * (texel.y * u_normal_scale) + n * texel.z;
    return any(isnan(bent)) ? n : normalize(bent);
}
#endif

vec3 surface_normal(bool front, vec3 v) {
    float side = front ? 1.0 : -1.0;
    vec3 n = normalize(v_normal);
#ifdef NORMAL_MAP
    n = mapped_normal(n, map_point(u_normal_map_uv, NORMAL_MAP));
#endif
    n *= side;
    // No normal points away from the viewer.
    float facing = dot(n, v);
    return facing < 0.001 ? normalize(n + v * (0.001 - facing)) : n;
}

Surface surface_here() {
    Surface s;
    vec3 v = normalize(u_eye - v_position);
    s.position = v_position;
    s.front = gl_FrontFacing;
    s.normal = surface_normal(s.front, v);
    vec4 base = u_base_color * v_color;
#ifdef BASE_COLOR_MAP
    base *= texture(u_base_color_map, map_point(u_base_color_map_uv, BASE_COLOR_MAP));
#endif
    s.opacity = u_blend ? clamp(base.a, 0.0, 1.0) : 1.0;
    if (base.a < u_alpha_cutoff) discard;
    float metalness = u_metalness, roughness = u_roughness;
#ifdef METALLIC_ROUGHNESS_MAP
    vec4 texel = texture(u_metallic_roughness_map, map_point(u_metallic_roughness_map_uv, METALLIC_ROUGHNESS_MAP));
    metalness *= texel.b;
    roughness *= texel.g;
#endif
    if (u_override) {
        base.rgb = u_override_color;
        metalness = u_override_metalness;
        roughness = u_override_roughness;
    }
    s.roughness = max(clamp(roughness, 0.0, 1.0), 0.01);  // alpha = roughness², at least 1e-4
    float ratio = (u_ior - 1.0) / (u_ior + 1.0);
    s.dielectric_f0 = min(ratio * ratio * u_specular_tint, vec3(1.0)) * u_specular_weight;
    s.dielectric_f90 = vec3(u_specular_weight);
    s.f0 = mix(s.dielectric_f0, base.rgb, metalness);
    s.f90 = mix(s.dielectric_f90, vec3(1.0), metalness);
    s.diffuse = base.rgb * (1.0 - metalness);
    s.ior = u_ior;
    s.occlusion = 1.0;
#ifdef OCCLUSION_MAP
    float open = texture(u_occlusion_map, map_point(u_occlusion_map_uv, OCCLUSION_MAP)).r;
    if (u_occlusion) s.occlusion = 1.0 + u_occlusion_strength * (open - 1.0);
#endif
    s.emission = u_emission;
#ifdef EMISSION_MAP
    s.emission *= texture(u_emission_map, map_point(u_emission_map_uv, EMISSION_MAP)).rgb;
#endif
    s.unlit = u_unlit;
    if (s.unlit) s.emission = base.rgb;
    return s;
}
