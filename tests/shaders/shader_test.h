#pragma once
// Helpers of the tests of docs/shaders: conversions of values to those of a shader and back, and a surface for the C++.

#include "domelight/base/vec.h"
#include "domelight/scene/scene.h"

#include "render/shading/shading_models.h"
#include "shaders/shading_language.h"

namespace domelight::test {

inline shading_language::vec3 to_shader(const Vec3f& v) {
    return {v.x, v.y, v.z};
}
inline shading_language::vec4 to_shader4(const Vec3f& v) {
    return {v.x, v.y, v.z, 1};
}
inline shading_language::mat3 to_shader(const Mat3& m) {
    const Mat3 columns = m.transposed();
    shading_language::mat3 out;
    for (std::size_t i = 0; i < 3; ++i) out.column[i] = to_shader(Vec3f(columns.row[i]));
    return out;
}
inline Vec3f from_shader(const shading_language::vec3& v) {
    return {v.x, v.y, v.z};
}

inline bool near(const Vec3f& a, const Vec3f& b, float tolerance) {
    return length(a - b) <= tolerance * length(b);
}

/// The error of rounding each operation to float.
constexpr float k_rounding = 2e-5f;

/// glTF's metallic-roughness material.
struct Paint {
    Vec3f base_color;
    float metallic, roughness;
};

inline Vec3f shade_split_sum(const Paint& m, const Vec3f& normal, const Vec3f& v, const LightMaps& maps,
                             const ShadingOptions& options) {
    SurfacePoint p;
    p.normal = normal;
    p.bsdf.kind = Bsdf::Kind::metallic_roughness;
    p.bsdf.alpha = m.roughness * m.roughness;
    p.bsdf.diffuse = m.base_color * (1 - m.metallic);
    const float f0 = f0_of_reflectance(0.5f);
    p.bsdf.f0 = Vec3f{f0, f0, f0} * (1 - m.metallic) + m.base_color * m.metallic;
    p.bsdf.f90 = {1, 1, 1};
    const ShadedLight light = domelight::shade_split_sum(p, v, 1, maps, options);
    return light.diffuse + light.specular;
}

}  // namespace domelight::test
