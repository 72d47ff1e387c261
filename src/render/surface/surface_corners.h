#pragma once
// A point of a mesh: values interpolated from its corners, and the directions of its textures.

#include "render/ray_scene.h"
#include "render/texture_lookup.h"

namespace domelight {

inline Vec3f unit_or(const Vec3f& v, const Vec3f& otherwise) {
    const float n = dot(v, v);
    return n > 1e-30f && std::isfinite(n) ? v / std::sqrt(n) : otherwise;
}

/// A triangle's corners and the weights of a point in it.
struct Corners {
    const Mesh& mesh;
    std::uint32_t i[3];
    float w[3];
    Corners(const Mesh& m, const Hit& hit) : mesh(m), w{1 - hit.u - hit.v, hit.u, hit.v} {
        for (int k = 0; k < 3; ++k) i[k] = m.indices[3 * std::size_t(hit.triangle) + k];
    }
    Vec3f mean(const std::vector<Vec3f>& values) const {
        return values[i[0]] * w[0] + values[i[1]] * w[1] + values[i[2]] * w[2];
    }
    Mesh::TexCoord texcoord(int set) const {
        const auto& t = mesh.texcoords[set == 1 ? 1 : 0];
        if (t.empty()) return {};
        return {t[i[0]].u * w[0] + t[i[1]].u * w[1] + t[i[2]].u * w[2],
                t[i[0]].v * w[0] + t[i[1]].v * w[1] + t[i[2]].v * w[2]};
    }
};

inline Rgba look_up(const Scene& scene, const SceneTexture& t, const Corners& c, bool srgb) {
    return t ? look_up(scene, t, c.texcoord(t.texcoord), srgb) : Rgba{};
}

/// The directions in which texture coordinates grow (u, and against v), in the world, perpendicular to `normal`, unit
/// length; zeros if they are undefined.
struct Tangents {
    Vec3f tangent, bitangent;
    bool known = false;
};
/// The tangents of the mesh if it has them, otherwise from set `texcoord` of the texture coordinates.
Tangents tangents_at(const Corners& c, int texcoord, const Affine& to_world, const Vec3f& normal);

/// `normal` changed by a normal map.
Vec3f mapped_normal(const Scene& scene, const SceneTexture& map, float scale, const Corners& c, const Affine& to_world,
                    const Vec3f& normal);

/// A normal that faces away from the viewer would make the surface black: it is turned until it just faces the viewer.
Vec3f facing_normal(const Vec3f& normal, const Vec3f& direction, const Vec3f& otherwise);

}  // namespace domelight
