#include "domelight/scene/scene.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace domelight;

TEST_CASE("scene: bounds and triangles count every instance") {
    Scene scene;
    CHECK(scene.bounds().low == Vec3f{});
    CHECK(scene.triangle_count() == 0);
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, {}, "a"});
    scene.instances.push_back({0, {{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {10, 0, 3}}, "b"});
    CHECK(scene.triangle_count() == 2);
    CHECK(scene.bounds().low == Vec3f{0, 0, 0});
    CHECK(scene.bounds().high == Vec3f{10, 2, 3});
    // A turned triangle whose own box extends beyond the bounds of the others, although the triangle itself does not.
    scene.instances.push_back({0, {{7, 7, 0}, {-7, 7, 0}, {0, 0, 1}, {7, -5.5f, 0}}, "c"});
    CHECK(scene.bounds().low == Vec3f{0, -5.5f, 0});
    CHECK(scene.bounds().high == Vec3f{14, 2, 3});
}

TEST_CASE("scene: an affine map turns normals as planes, and products apply the right factor first") {
    const Affine a{{2, 0, 0}, {0, 0, 1}, {1, 3, 0}, {5, 6, 7}}, b{{0, 1, 0}, {-1, 0.5f, 0}, {0, 0, 4}, {1, 1, 1}};
    const Vec3f p{0.3f, -0.7f, 2};
    CHECK(length((a * b).point(p) - a.point(b.point(p))) < 1e-5f);
    // A normal remains perpendicular to the plane, and on the same side.
    const Vec3f u{1, 2, 0.5f}, v{-1, 0, 3}, n = cross(u, v);
    CHECK(std::abs(dot(a.normal(n), a.vector(u))) < 1e-4f);
    CHECK(std::abs(dot(a.normal(n), a.vector(v))) < 1e-4f);
    CHECK(length(a.normal(n) - cross(a.vector(u), a.vector(v))) < 1e-4f);
    CHECK(a.determinant() == doctest::Approx(dot(cross(a.x, a.y), a.z)));
}

TEST_CASE("built-in scenes: closed, facing outwards, in front of their camera") {
    for (const char* name : {"spheres", "ball", "furnace"}) {
        INFO(name);
        const auto scene = built_in_scene(name);
        REQUIRE(scene);
        REQUIRE(scene->cameras.size() == 1);
        CHECK(scene->warnings.empty());
        for (const Instance& instance : scene->instances) {
            const Mesh& mesh = scene->meshes[std::size_t(instance.mesh)];
            CHECK(std::size_t(mesh.material) < scene->materials.size());
            REQUIRE(mesh.normals.size() == mesh.positions.size());
            REQUIRE(mesh.texcoords[0].size() == mesh.positions.size());
            CHECK(instance.to_world.determinant() > 0);
            std::int64_t against = 0, flat = 0;
            for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
                const std::uint32_t i[3] = {mesh.indices[t], mesh.indices[t + 1], mesh.indices[t + 2]};
                const Vec3f face =
                    cross(mesh.positions[i[1]] - mesh.positions[i[0]], mesh.positions[i[2]] - mesh.positions[i[0]]);
                for (const std::uint32_t k : i) against += dot(face, mesh.normals[k]) <= 0;
                flat += length(face) == 0;
            }
            CHECK(against == 0);
            CHECK(flat == 0);
            float off = 0;
            for (const Vec3f& n : mesh.normals) off = std::max(off, std::abs(length(n) - 1));
            CHECK(off < 1e-6f);
        }
        // The camera looks at the middle of the object.
        const Affine& view = scene->cameras[0].to_world;
        CHECK(length(cross(view.x, view.y) - view.z) < 1e-6f);
        const Vec3f middle = scene->meshes[0].positions.empty() ? Vec3f{} : scene->instances[0].to_world.translation;
        CHECK(dot(middle - view.translation, view.z) < 0);
    }
}

TEST_CASE("built-in scenes: seven roughnesses in metal above dielectric; a white unit sphere; no other name") {
    const auto spheres = built_in_scene("spheres");
    REQUIRE(spheres->instances.size() == 14);
    std::set<float> roughness;
    for (const Instance& instance : spheres->instances) {
        const Material& m = spheres->materials[std::size_t(spheres->meshes[std::size_t(instance.mesh)].material)];
        roughness.insert(m.roughness);
        CHECK((instance.to_world.translation.y > 0) == (m.metalness == 1));
        CHECK(instance.to_world.translation.x == doctest::Approx(m.roughness * 6 - 3));
    }
    CHECK(roughness.size() == 7);
    const auto furnace = built_in_scene("furnace");
    CHECK(furnace->materials[0].base_color == Vec3f{1, 1, 1});
    float off = 0;
    for (const Vec3f& p : furnace->meshes[0].positions) off = std::max(off, std::abs(length(p) - 1));
    CHECK(off < 1e-6f);
    const auto none = built_in_scene("teapot");
    REQUIRE(!none);
    CHECK(none.error().format().find("spheres, ball, furnace") != std::string::npos);
}
