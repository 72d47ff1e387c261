#pragma once
// What the fuzz targets of the scene readers share.

#include "scene/mesh/mesh_repair.h"
#include "scene/scene_readers.h"

#include <cmath>
#include <cstdlib>

namespace domelight::fuzz {

/// What the renderer relies on, whatever the file was.
inline void check_scene(const Scene& scene) {
    const auto require = [](bool holds) {
        if (!holds) std::abort();
    };
    for (const Instance& instance : scene.instances)
        require(instance.mesh >= 0 && std::size_t(instance.mesh) < scene.meshes.size());
    const auto [low, high] = scene.bounds();
    require(is_sound(low) && is_sound(high));
    for (const Mesh& mesh : scene.meshes) {
        const std::size_t vertices = mesh.positions.size();
        require(mesh.material >= 0 && std::size_t(mesh.material) < scene.materials.size());
        require(mesh.indices.size() % 3 == 0);
        for (const std::uint32_t index : mesh.indices) require(index < vertices);
        for (const Vec3f& p : mesh.positions) require(is_sound(p));
        require(mesh.normals.empty() || mesh.normals.size() == vertices);
        for (const Vec3f& n : mesh.normals) require(std::abs(dot(n, n) - 1) < 1e-4f);
        require(mesh.tangents.empty() || mesh.tangents.size() == vertices);
        require(mesh.colors.empty() || mesh.colors.size() == vertices);
        for (const auto& set : mesh.texcoords) require(set.empty() || set.size() == vertices);
    }
    for (const Rgba8Image& image : scene.images)
        require(image.rgba.size() == std::size_t(image.width) * std::size_t(image.height) * 4);
}

inline constexpr std::int64_t k_scene_bytes = 64 << 20;

/// Nothing is found there.
inline const std::filesystem::path k_no_folder = "/nonexistent/folder";

}  // namespace domelight::fuzz
