#include "domelight/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// A point of a profile that is turned about the y axis, and the normal there; bottom to top, with the outside at
/// larger radii.
struct ProfilePoint {
    double radius = 0, height = 0, normal_radius = 1, normal_height = 0;
};
using Profile = std::vector<ProfilePoint>;

/// An arc of a circle about (centre_radius, centre_height); angles from the horizontal.
Profile arc(double centre_radius, double centre_height, double radius, double from, double to, int steps) {
    Profile profile;
    for (int i = 0; i <= steps; ++i) {
        const double angle = from + (to - from) * i / steps;
        // Poles exactly on the axis.
        const double c = std::abs(std::abs(angle) - k_pi / 2) < 1e-9 ? 0 : std::cos(angle), s = std::sin(angle);
        profile.push_back({centre_radius + radius * c, centre_height + radius * s, c, s});
    }
    return profile;
}

Profile line(double radius_0, double height_0, double radius_1, double height_1) {
    const double l = std::hypot(radius_1 - radius_0, height_1 - height_0);
    const double nr = (height_1 - height_0) / l, nh = (radius_0 - radius_1) / l;
    return {{radius_0, height_0, nr, nh}, {radius_1, height_1, nr, nh}};
}

/// Adds the surface of revolution of a profile; u runs round the axis from +z by +x, v from top to bottom.
void add_lathe(Mesh& mesh, const Profile& profile, int segments) {
    const auto base = std::uint32_t(mesh.positions.size());
    const auto row = std::uint32_t(segments + 1);
    for (std::size_t j = 0; j < profile.size(); ++j)
        for (int i = 0; i <= segments; ++i) {
            const ProfilePoint& p = profile[j];
            const double angle = 2 * k_pi * (i % segments) / segments, s = std::sin(angle), c = std::cos(angle);
            mesh.positions.push_back({float(p.radius * s), float(p.height), float(p.radius * c)});
            mesh.normals.push_back({float(p.normal_radius * s), float(p.normal_height), float(p.normal_radius * c)});
            mesh.texcoords[0].push_back({float(i) / float(segments), 1 - float(j) / float(profile.size() - 1)});
        }
    for (std::uint32_t j = 0; j + 1 < profile.size(); ++j)
        for (std::uint32_t i = 0; i < std::uint32_t(segments); ++i) {
            const std::uint32_t a = base + j * row + i, b = a + 1, c = a + row + 1, d = a + row;
            if (profile[j].radius > 0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
            if (profile[j + 1].radius > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
        }
}

Mesh sphere(int material, int segments) {
    Mesh mesh;
    mesh.name = "sphere";
    mesh.material = material;
    add_lathe(mesh, arc(0, 0, 1, -k_pi / 2, k_pi / 2, segments / 2), segments);
    return mesh;
}

/// A square of the plane y = 0 about the origin.
Mesh ground(int material, float half) {
    Mesh mesh;
    mesh.name = "ground";
    mesh.material = material;
    mesh.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

Material material(std::string name, const Vec3f& colour, float metalness, float roughness) {
    Material m;
    m.name = std::move(name);
    m.base_color = colour;
    m.metalness = metalness;
    m.roughness = roughness;
    return m;
}

void add(Scene& scene, Mesh mesh, const Affine& to_world = {}) {
    scene.instances.push_back({int(scene.meshes.size()), to_world, mesh.name});
    scene.meshes.push_back(std::move(mesh));
}

void add_camera(Scene& scene, const Vec3f& eye, const Vec3f& target, float fov_y, float aspect) {
    const Vec3f z = normalize(eye - target), x = normalize(cross(Vec3f{0, 1, 0}, z));
    Camera camera;
    camera.to_world = {x, cross(z, x), z, eye};
    camera.fov_y = fov_y;
    camera.aspect = aspect;
    camera.name = "camera";
    scene.cameras.push_back(std::move(camera));
}

/// Gold above red plastic; roughness 0 to 1 from left to right.
Scene spheres() {
    constexpr int columns = 7;
    constexpr float radius = 0.46f;
    Scene scene;
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < columns; ++column) {
            const bool metal = row == 0;
            const float roughness = float(column) / float(columns - 1);
            const std::string name = fmt::format("{} {:.2f}", metal ? "metal" : "dielectric", roughness);
            scene.materials.push_back(material(name, metal ? Vec3f{1.0f, 0.766f, 0.336f} : Vec3f{0.5f, 0.05f, 0.04f},
                                               metal ? 1.0f : 0.0f, roughness));
            Mesh mesh = sphere(int(scene.materials.size()) - 1, 128);
            mesh.name = name;
            add(scene, std::move(mesh),
                {{radius, 0, 0}, {0, radius, 0}, {0, 0, radius}, {float(column) - 3.0f, metal ? 0.5f : -0.5f, 0}});
        }
    // Far away, so that all spheres are seen nearly alike.
    constexpr float half_width = 3.65f, aspect = 2;
    add_camera(scene, {0, 0, 20}, {}, 2 * std::atan(half_width / aspect / 20), aspect);
    return scene;
}

/// A ball with a groove, in a collar on a plinth.
Scene ball() {
    Scene scene;
    scene.materials = {material("ball", {0.955f, 0.638f, 0.538f}, 1, 0.25f),
                       material("plinth", {0.18f, 0.18f, 0.19f}, 0, 0.45f),
                       material("ground", {0.42f, 0.42f, 0.42f}, 0, 0.9f)};
    constexpr int segments = 192;
    constexpr double centre = 1.34, groove = 0.16, depth = 0.05;
    Mesh outer;
    outer.name = "ball";
    // The groove: a band of smaller radius about the equator.
    add_lathe(outer, arc(0, centre, 1, -k_pi / 2, -groove, 80), segments);
    add_lathe(outer,
              line(std::cos(groove), centre - std::sin(groove), std::cos(groove) - depth, centre - std::sin(groove)),
              segments);
    add_lathe(
        outer,
        line(std::cos(groove) - depth, centre - std::sin(groove), std::cos(groove) - depth, centre + std::sin(groove)),
        segments);
    add_lathe(outer,
              line(std::cos(groove) - depth, centre + std::sin(groove), std::cos(groove), centre + std::sin(groove)),
              segments);
    add_lathe(outer, arc(0, centre, 1, groove, k_pi / 2, 80), segments);
    add(scene, std::move(outer));

    Mesh plinth;
    plinth.name = "plinth";
    plinth.material = 1;
    constexpr double bevel = 0.04, low = 0.22, high = 0.62;
    add_lathe(plinth, line(1.1, 0, 1.1, low - bevel), segments);
    add_lathe(plinth, arc(1.1 - bevel, low - bevel, bevel, 0, k_pi / 2, 8), segments);
    add_lathe(plinth, line(1.1 - bevel, low, 0.62 + bevel, low), segments);
    add_lathe(plinth, line(0.62 + bevel, low, 0.72, high - bevel), segments);
    add_lathe(plinth, arc(0.72 - bevel, high - bevel, bevel, 0, k_pi / 2, 8), segments);
    add_lathe(plinth, line(0.72 - bevel, high, 0, high), segments);
    add(scene, std::move(plinth));

    add(scene, ground(2, 12));
    add_camera(scene, {0, 2.6f, 6.2f}, {0, 1.15f, 0}, 0.52f, 1);
    return scene;
}

/// White metal: what a white furnace must make disappear.
Scene furnace() {
    Scene scene;
    scene.materials.push_back(material("white", {1, 1, 1}, 1, 0.5f));
    add(scene, sphere(0, 512));
    add_camera(scene, {0, 0, 4.2f}, {}, 0.61f, 1);
    return scene;
}

struct BuiltInScene {
    const char* name;
    Scene (*make)();
};
constexpr BuiltInScene k_scenes[] = {{"spheres", spheres}, {"ball", ball}, {"furnace", furnace}};

}  // namespace

std::vector<std::string> built_in_scene_names() {
    std::vector<std::string> names;
    for (const BuiltInScene& scene : k_scenes) names.emplace_back(scene.name);
    return names;
}

Result<Scene> built_in_scene(const std::string& name) {
    for (const BuiltInScene& scene : k_scenes)
        if (name == scene.name) return scene.make();
    std::string names;
    for (const BuiltInScene& scene : k_scenes) names += (names.empty() ? "" : ", ") + std::string(scene.name);
    return Error{fmt::format("there is no built-in scene '{}'", name.substr(0, 40)), "", "There are " + names + "."};
}

Result<Scene> open_scene(const std::string& name_or_file, const SceneOptions& options) {
    const bool is_built_in =
        std::ranges::any_of(k_scenes, [&](const BuiltInScene& scene) { return name_or_file == scene.name; });
    return is_built_in ? built_in_scene(name_or_file) : load_scene(name_or_file, options);
}

}  // namespace domelight
