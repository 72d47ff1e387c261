#include "gltf_samples.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

TEST_CASE("obj: faces in all their notations, with negative indices and lines that go on") {
    const auto scene = load_text(
        "# a comment\r\n"
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0.25\nvn 0 0 1\n"
        "o first\nf 1 2 3\nf -4/1 -2/2 -1/1\n"
        "o second\nf 1//1 2//1 \\\n3//1\n"
        "o third\nf 1/1/1 2/2/1 3/1/1 4/1/1\nl 1 2\n",
        "a.obj");
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->meshes.size() == 3);
    CHECK(scene->instances[0].name == "first");
    CHECK(scene->meshes[0].triangle_count() == 2);
    CHECK(scene->meshes[0].normals.empty());
    CHECK(scene->meshes[0].texcoords[0].empty());  // only some corners have them
    CHECK(scene->meshes[1].normals == std::vector<Vec3f>(3, {0, 0, 1}));
    CHECK(scene->meshes[2].triangle_count() == 2);
    CHECK(scene->meshes[2].positions.size() == 4);
    CHECK(scene->meshes[2].texcoords[0][1].v == 0.75f);  // v runs downwards here
    CHECK(warns(*scene, "1 lines"));
}

TEST_CASE("obj: concave polygons are cut inside") {
    // An L of area 3, where a fan from the first corner would cover more, in planes of all six directions.
    constexpr float k_l[6][2] = {{2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}};
    for (int direction = 0; direction < 6; ++direction) {
        std::string text;
        Vec3f normal;
        for (const auto& corner : k_l) {
            const float x = direction < 3 ? corner[0] : -corner[0], y = corner[1];
            const Vec3f p = direction % 3 == 0 ? Vec3f{x, y, 5} : direction % 3 == 1 ? Vec3f{5, x, y} : Vec3f{y, 5, x};
            text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
        }
        const float side = direction < 3 ? 1.0f : -1.0f;
        normal = direction % 3 == 0 ? Vec3f{0, 0, side} : direction % 3 == 1 ? Vec3f{side, 0, 0} : Vec3f{0, side, 0};
        const auto scene = load_text(text + "f 3 4 5 6 1 2\n", "a.obj");
        REQUIRE_MESSAGE(scene, error_of(scene));
        const Mesh& mesh = scene->meshes[0];
        CHECK(mesh.triangle_count() == 4);
        double area = 0;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
            CHECK(dot(cross(b - a, c - a), normal) > 0);
            area += dot(cross(b - a, c - a), normal) / 2;
        }
        CHECK(area == doctest::Approx(3));
    }
}

TEST_CASE("obj: smoothing groups give normals where the file has none") {
    const std::string roof = "v -1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const auto flat = load_text(roof + "f 1 4 3\nf 4 2 3\n", "a.obj");
    const auto smooth = load_text(roof + "s 1\nf 1 4 3\nf 4 2 3\n", "a.obj");
    REQUIRE(flat);
    REQUIRE(smooth);
    CHECK(flat->meshes[0].normals.empty());
    REQUIRE(smooth->meshes[0].normals.size() == 4);
    CHECK(near(smooth->meshes[0].normals[1], normalize(Vec3f{0, 1, 1})));  // the ridge, between the two sides
}

TEST_CASE("obj: materials become metallic-roughness") {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.mtl")
        << "newmtl shiny paint\nKd 0.5 0.25 0.125\nKs 0.5 0.5 0.5\nNs 30\nd 0.5\nmap_Bump x.png\n"
           "newmtl metal\nPm 1\nPr 0.25\nKe 2 2 2\n";
    std::ofstream(folder / "a.obj")
        << "mtllib a.mtl\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl metal\nf 1 2 3\nusemtl shiny paint\n"
           "f 1 2 3\nusemtl unknown\nf 1 2 3\n";
    const auto scene = load_scene(folder / "a.obj");
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->meshes.size() == 3);
    const Material& paint = scene->materials[std::size_t(scene->meshes[1].material)];
    CHECK(paint.base_color == Vec3f{0.5f, 0.25f, 0.125f});
    CHECK(paint.metalness == 0);
    CHECK(paint.roughness == doctest::Approx(0.5));  // α = √(2 / 32) = 1/4
    CHECK(paint.specular_color == Vec3f{1, 1, 1});   // F0 = 0.08 Ks = 0.04
    CHECK((paint.opacity == 0.5f && paint.alpha_mode == Material::AlphaMode::blend));
    const Material& metal = scene->materials[std::size_t(scene->meshes[0].material)];
    CHECK((metal.metalness == 1 && metal.roughness == 0.25f && metal.emission == Vec3f{2, 2, 2}));
    CHECK(warns(*scene, "none.mtl"));
    CHECK(warns(*scene, "'unknown' is not defined"));
    CHECK(warns(*scene, "map_Bump is not read"));
    CHECK(warns(*scene, "approximated"));
    // Neither material libraries nor their images may lie outside the folder.
    std::ofstream(folder / "b.obj") << "mtllib ../a.mtl\n";
    CHECK(contains(error_of(load_scene(folder / "b.obj")), "leaves the folder"));
    std::ofstream(folder / "a.mtl") << "newmtl m\nmap_Kd -s 2 2 2 -clamp on ../../x y.png\n";
    auto outside = load_scene(folder / "a.obj");
    REQUIRE_MESSAGE(outside, error_of(outside));
    CHECK(warns(*outside, "../../x y.png: leaves the folder"));
    // Where a picture is missing or foreign, the material has its factor alone, and no light of its own.
    std::ofstream(folder / "t.bmp", std::ios::binary) << "BM123456789";
    std::ofstream(folder / "a.mtl") << "newmtl m\nKd 0.5 0 0\nmap_Kd missing.png\nmap_Ke t.bmp\n";
    auto missing = load_scene(folder / "a.obj");
    REQUIRE_MESSAGE(missing, error_of(missing));
    CHECK(warns(*missing, "missing.png: no such file: left out, its materials have their factors alone"));
    CHECK(warns(*missing, "t.bmp: BMP, neither PNG nor JPEG nor WebP"));
    for (const Material& m : missing->materials)
        if (m.name == "m") {
            CHECK((!m.base_color_texture && m.base_color == Vec3f{0.5f, 0, 0}));
            CHECK((!m.emission_texture && m.emission == Vec3f{}));
        }
}

TEST_CASE("obj: a missing library is missing, also where the scene is named without a folder") {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const auto scene = load_scene("a.obj");
    std::filesystem::current_path(before);
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(warns(*scene, "none.mtl: no such file: its materials are left out"));
}

TEST_CASE("obj: what is broken is named by its line") {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(contains(error_of(load_text(three + "f 1 2 4\n", "a.obj")), "line 4: face with a corner '4'"));
    CHECK(contains(error_of(load_text(three + "f 0 1 2\n", "a.obj")), "line 4"));
    CHECK(contains(error_of(load_text(three + "f -4 1 2\n", "a.obj")), "line 4"));
    CHECK(contains(error_of(load_text(three + "f 1/1 2 3\n", "a.obj")), "line 4"));
    CHECK(contains(error_of(load_text(three + "f 99999999999999999999 1 2\n", "a.obj")), "line 4"));
    CHECK(contains(error_of(load_text(three + "f 1 2\n", "a.obj")), "fewer than three"));
    CHECK(contains(error_of(load_text("v 0 zero 0\n", "a.obj")), "line 1: vertex without three numbers"));
    CHECK(contains(error_of(load_text("# nothing\n", "a.obj")), "no triangles"));
    const auto mended = load_text(three + "v nan 0 0\nv 1e99 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\n", "a.obj");
    REQUIRE_MESSAGE(mended, error_of(mended));
    CHECK(mended->triangle_count() == 1);
    CHECK(warns(*mended, "2 triangles left out"));
}
