#include "domelight/capture/probe_bake.h"

#include "domelight/probe/scene_hash.h"

#include "io/file/sha256.h"
#include "render/shapes.h"
#include "test.h"
#include "texture/container/cube_array.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace domelight {
namespace {

namespace fs = std::filesystem;

Scene small_scene() {
    Scene scene;
    test::add(scene, test::floor_mesh(2, -1), test::lambert_material(0.7f));
    test::add(scene, test::sphere_mesh(8), test::metal_material(0.3f), {.translation = {0, 0, -3}});
    return scene;
}

struct Small {
    RayScene scene = *RayScene::build(small_scene());
    ImageF image{16, 8, 3, 0.5f};
    EnvironmentSampler sky = *EnvironmentSampler::build(image.view(), reference_sampler_options());
    ProbeGrid grid{.origin = {-1, 0, 0}, .nx = 3};
    std::vector<Probe> probes;
    ProbeBakeOptions options;

    Small() {
        for (int i = 0; i < 3; ++i) probes.push_back({.place = grid.place(i), .position = grid.place(i)});
        probes[2].valid = false, probes[2].filled_from = 0;
        probes[1].influence = {ProbeInfluence::Shape::box, {{-1, -1, -1}, {1, 2, 3}}, 0, 0.25f};
        probes[1].proxy = ProbeBox{{-2, -1, -2}, {2, 3, 2}};
        options.capture.size = 16, options.capture.samples = 4;
        options.scene = {"small.glb", scene_sha256(scene.scene())};
        options.environment = {"grey.hdr", std::string(64, 'a')};
    }
};

std::vector<std::string> hashes(const fs::path& folder) {
    std::vector<std::string> all;
    for (const char* name : {"probes.json", "specular.ktx2", "irradiance.ktx2", "distance.ktx2"})
        all.push_back(*sha256_file(folder / name));
    return all;
}

TEST_CASE("bake_probes: the files hold what the set in memory has") {
    const test::TemporaryFolder folder;
    Small s;
    const auto report = bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, folder / "set");
    REQUIRE(report);
    CHECK(report->rays > 0);
    const auto memory = bake_probes(s.scene, s.sky, s.probes, s.grid, s.options);
    REQUIRE(memory);
    const auto file = ProbeSet::load(folder / "set");
    REQUIRE(file);
    CHECK(file->scene().file == "small.glb");
    CHECK(file->scene().sha256 == s.options.scene.sha256);
    CHECK(file->environment().sha256 == s.options.environment.sha256);
    REQUIRE(file->grid());
    CHECK(file->grid()->origin == s.grid.origin);
    CHECK(file->grid()->nx == 3);
    CHECK(file->roughness().size() == memory->roughness().size());
    for (std::size_t i = 0; i < 3; ++i) {
        const Probe &a = file->probes()[i], &b = s.probes[i];
        CHECK(a.place == b.place);
        CHECK(a.position == b.position);
        CHECK(a.valid == b.valid);
        CHECK(a.filled_from == b.filled_from);
        CHECK(a.influence.shape == b.influence.shape);
        CHECK(a.influence.fade == b.influence.fade);
        CHECK(a.proxy.has_value() == b.proxy.has_value());
        for (const Vec3f& d : {Vec3f{1, 0.2f, 0.1f}, {0, -1, 0.3f}, {-1, 1, 1}}) {
            CHECK(file->radiance(int(i), d, 0.4f) == memory->radiance(int(i), d, 0.4f));
            CHECK(file->irradiance_over_pi(int(i), d) == memory->irradiance_over_pi(int(i), d));
            CHECK(file->distance(int(i), d).mean == memory->distance(int(i), d).mean);
            const double difference =
                length(Vec3d(file->irradiance_over_pi_sh(int(i), d)) - Vec3d(memory->irradiance_over_pi_sh(int(i), d)));
            CHECK(difference < 1e-6);
        }
    }
    CHECK(file->probes()[1].proxy->high == Vec3f{2, 3, 2});
    CHECK(file->probes()[1].influence.box.high == Vec3f{1, 2, 3});
    // The invalid probe has the light of the one that it is filled from.
    CHECK(file->radiance(2, {0, 0, 1}, 0) == file->radiance(0, {0, 0, 1}, 0));
}

TEST_CASE("bake_probes: the same bytes on any number of threads") {
    const test::TemporaryFolder folder;
    Small s;
    s.options.capture.threads = 1;
    REQUIRE(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, folder / "one"));
    s.options.capture.threads = 3;
    REQUIRE(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, folder / "three"));
    CHECK(hashes(folder / "one") == hashes(folder / "three"));
}

TEST_CASE("bake_probes: nothing appears where it fails, and a folder of an older set is replaced whole") {
    const test::TemporaryFolder folder;
    Small s;
    ProbeBakeOptions cancelled = s.options;
    cancelled.capture.progress = [](std::string_view, double) { return false; };
    CHECK(bake_probes(s.scene, s.sky, s.probes, s.grid, cancelled, folder / "set").error().what == "cancelled");
    CHECK_FALSE(fs::exists(folder / "set"));
    REQUIRE(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, folder / "set"));
    const auto before = hashes(folder / "set");
    CHECK_FALSE(bake_probes(s.scene, s.sky, s.probes, s.grid, cancelled, folder / "set"));
    CHECK(hashes(folder / "set") == before);
    s.options.capture.seed = 5;
    REQUIRE(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, folder / "set"));
    CHECK(hashes(folder / "set") != before);
    CHECK(std::distance(fs::directory_iterator(folder / "set"), {}) == 4);
}

TEST_CASE("bake_probes: a scene without light, no probes, and options out of range are errors") {
    const test::TemporaryFolder folder;
    Small s;
    const ImageF black(8, 4, 3);
    const auto dark = *EnvironmentSampler::build(black.view(), reference_sampler_options());
    CHECK(bake_probes(s.scene, dark, s.probes, s.grid, s.options).error().what.starts_with("the environment is black"));
    CHECK(bake_probes(s.scene, s.sky, {}, std::nullopt, s.options).error().where == "`probes`");
    ProbeBakeOptions wrong = s.options;
    wrong.encoding = Encoding::bc6h;
    CHECK(bake_probes(s.scene, s.sky, s.probes, s.grid, wrong, folder / "set").error().where == "`encoding`");
    wrong = s.options, wrong.capture.size = 5;
    CHECK(bake_probes(s.scene, s.sky, s.probes, s.grid, wrong).error().where == "`size`");
    CHECK(bake_probes(s.scene, s.sky, s.probes, ProbeGrid{}, s.options).error().where == "`grid`");
    s.probes[2].filled_from = 2;
    CHECK(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options).error().where == "`probes`");
}

TEST_CASE("ProbeSet::load: a damaged set is an error that names the file") {
    const test::TemporaryFolder folder;
    Small s;
    const fs::path set = folder / "set";
    REQUIRE(bake_probes(s.scene, s.sky, s.probes, s.grid, s.options, set));
    const auto where = [&] {
        const auto loaded = ProbeSet::load(set);
        return loaded ? std::string() : loaded.error().where;
    };
    CHECK(where().empty());
    const auto replace = [&](const std::string& from, const std::string& to) {
        std::ifstream in(set / "probes.json");
        std::string text((std::istreambuf_iterator<char>(in)), {});
        const auto at = text.find(from);
        REQUIRE(at != std::string::npos);
        std::ofstream(set / "probes.json") << text.replace(at, from.size(), to);
    };
    const fs::path json = set / "probes.json";
    for (const auto& [from, to] : {std::pair{"\"format\": 1", "\"format\": 9"},
                                   {"\"valid\":true", "\"valid\":3"},
                                   {"\"filled_from\":0", "\"filled_from\":8"},
                                   {"\"file\": \"specular.ktx2\"", "\"file\": \"../specular.ktx2\""},
                                   {"\"harmonics\":[", "\"harmonics\":[1,"},
                                   {"\"roughness\": 1.0", "\"roughness\": 7.0"}}) {
        INFO(from);
        replace(from, to);
        CHECK(where() == json.string());
        replace(to, from);
        CHECK(where().empty());
    }
    fs::resize_file(set / "irradiance.ktx2", 200);
    CHECK(where() == (set / "irradiance.ktx2").string());
    fs::remove(set / "irradiance.ktx2");
    CHECK_FALSE(where().empty());
}

TEST_CASE("CubeArrayWriter: any reader of KTX2 sees an array of cubes, and every cube comes back") {
    const test::TemporaryFolder folder;
    const CubeArrayShape shape{Encoding::rgba16f, 4, 3, 5, {{"key", "value"}}};
    auto writer = CubeArrayWriter::open(folder / "a.ktx2", shape);
    REQUIRE(writer);
    const auto texels = [&](int cube, int level) {
        std::vector<std::uint8_t> bytes(shape.cube_bytes(level));
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::uint8_t(cube * 50 + level * 10 + int(i % 7));
        return bytes;
    };
    for (const int cube : {3, 0, 4, 1, 2})
        for (int level = 0; level < 3; ++level) writer->write(cube, level, texels(cube, level));
    REQUIRE(writer->finish());
    const auto info = read_texture_info(folder / "a.ktx2");
    REQUIRE(info);
    CHECK(info->layers == 5);
    CHECK(info->faces == 6);
    CHECK(info->levels == 3);
    CHECK(info->width == 4);
    CHECK(info->metadata.at("key") == "value");
    auto reader = CubeArrayReader::open(folder / "a.ktx2");
    REQUIRE(reader);
    for (int cube = 0; cube < 5; ++cube)
        for (int level = 0; level < 3; ++level)
            CHECK(std::ranges::equal(*reader->read(cube, level), texels(cube, level)));
    CHECK_FALSE(CubeArrayReader::open(folder / "none.ktx2"));
}

TEST_CASE("scene_sha256: changes with geometry, materials, places and lights, not with names and cameras") {
    const std::string hash = scene_sha256(small_scene());
    CHECK(hash.size() == 64);
    const auto changed = [&](const auto& change) {
        Scene scene = small_scene();
        change(scene);
        return scene_sha256(scene) != hash;
    };
    CHECK_FALSE(changed([](Scene&) {}));
    CHECK_FALSE(changed([](Scene& s) { s.instances[0].name = "other", s.cameras.emplace_back(); }));
    CHECK(changed([](Scene& s) { s.meshes[0].positions[1].y += 1e-3f; }));
    CHECK(changed([](Scene& s) { s.meshes[0].indices[0] = 1; }));
    CHECK(changed([](Scene& s) { s.materials[1].roughness = 0.4f; }));
    CHECK(changed([](Scene& s) { s.materials[1].emission = {0, 0, 1}; }));
    CHECK(changed([](Scene& s) { s.instances[0].to_world.translation.x = 1; }));
    CHECK(changed([](Scene& s) { s.lights.push_back({}); }));
    CHECK(changed([](Scene& s) { s.images.push_back({"", 1, 1, {1, 2, 3, 4}}); }));
}

}  // namespace
}  // namespace domelight
