#pragma once
// Small scenes that the tests make.

#include "domelight/scene/scene.h"

#include <cmath>

namespace domelight::test {

/// A smooth sphere of unit radius about the origin, of `rings` bands with 2 · `rings` pairs of triangles each.
inline Mesh sphere_mesh(int rings) {
    Mesh mesh;
    const int columns = 2 * rings;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double theta = k_pi * j / rings, phi = 2 * k_pi * i / columns;
            const Vec3f p(Vec3d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
            mesh.positions.push_back(p);
            mesh.normals.push_back(p);
        }
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < columns; ++i) {
            const std::uint32_t a = std::uint32_t(j * (columns + 1) + i), b = a + 1, c = a + std::uint32_t(columns) + 1,
                                d = c + 1;
            // Counter-clockwise from outside; the poles' triangles of no area left out.
            if (j > 0) mesh.indices.insert(mesh.indices.end(), {a, b, d});
            if (j < rings - 1) mesh.indices.insert(mesh.indices.end(), {a, d, c});
        }
    return mesh;
}

/// A square of side 2 `half` in the plane y = height, facing up.
inline Mesh floor_mesh(float half, float height) {
    Mesh mesh;
    mesh.positions = {{-half, height, half}, {half, height, half}, {half, height, -half}, {-half, height, -half}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

inline void add(Scene& scene, Mesh mesh, Material material, const Affine& to_world = {}) {
    mesh.material = int(scene.materials.size());
    scene.materials.push_back(std::move(material));
    scene.instances.push_back({int(scene.meshes.size()), to_world, "object " + std::to_string(scene.instances.size())});
    scene.meshes.push_back(std::move(mesh));
}

inline Material lambert_material(float albedo) {
    Material m;
    m.lambert = true;
    m.base_color = {albedo, albedo, albedo};
    return m;
}
/// A perfect metal, F = 1.
inline Material metal_material(float roughness) {
    Material m;
    m.metalness = 1;
    m.roughness = roughness;
    return m;
}

}  // namespace domelight::test
