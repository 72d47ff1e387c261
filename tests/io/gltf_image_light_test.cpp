#include "scene/gltf/gltf_image_light.h"

#include "domelight/bake/bake.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/io/environment/open_environment.h"

#include "io/io_helpers.h"
#include "oriented.h"
#include "test.h"

#include <cmath>
#include <nlohmann/json.hpp>

using namespace domelight;
using namespace domelight::test;

namespace {

GltfImageLightFile sample_light(int size, int levels) {
    GltfImageLightFile light;
    light.cube = sample_texture(Encoding::rgbd, size, 6, levels);
    for (int i = 0; i < 9; ++i) light.irradiance.push_back({0.5 * i, 1.0 - i, 0.25});
    light.name = "studio";
    light.generator = "test";
    return light;
}

Result<GltfImageLight> read(const std::string& text, int levels = 32) {
    return read_gltf_image_light(FileBytes::from_memory({text.begin(), text.end()}), ".", 1 << 28, levels);
}

nlohmann::json sample_json(const TemporaryFolder& folder) {
    REQUIRE(write_gltf_image_light(folder / "a.gltf", sample_light(8, 3)));
    const auto bytes = file_bytes(folder / "a.gltf");
    return nlohmann::json::parse(bytes.begin(), bytes.end());
}

nlohmann::json& light_of(nlohmann::json& json) {
    return json["extensions"]["EXT_lights_image_based"]["lights"][0];
}

}  // namespace

TEST_CASE("gltf_image_light: what was written is read back") {
    const TemporaryFolder folder;
    const GltfImageLightFile light = sample_light(8, 3);
    REQUIRE(write_gltf_image_light(folder / "a.gltf", light));
    const auto bytes = FileBytes::open(folder / "a.gltf", 1 << 24);
    REQUIRE(bytes);
    CHECK(may_be_gltf_image_light((*bytes)->bytes()));
    const auto back = read_gltf_image_light(*bytes, folder.path(), 1 << 28);
    REQUIRE(back);
    CHECK(back->intensity == 1);
    CHECK(back->irradiance == light.irradiance);
    CHECK_FALSE(back->low_dynamic_range);
    REQUIRE(back->levels.size() == 3);
    for (int l = 0; l < 3; ++l)
        for (int f = 0; f < 6; ++f) {
            const ImageF face = decode_texture(light.cube, l, f);
            const auto read = back->levels[std::size_t(l)].face(f);
            REQUIRE(read.width == face.width());
            CHECK(std::equal(face.pixels().begin(), face.pixels().end(), read.data));
        }
}

TEST_CASE("gltf_image_light: the file is as the extension wants it") {
    const TemporaryFolder folder;
    auto json = sample_json(folder);
    CHECK(json["asset"]["version"] == "2.0");
    CHECK(json["extensionsUsed"][0] == "EXT_lights_image_based");
    CHECK(json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] == 0);
    CHECK(light_of(json)["specularImageSize"] == 8);
    CHECK(light_of(json)["irradianceCoefficients"].size() == 9);
    CHECK(light_of(json)["irradianceCoefficients"][2] == nlohmann::json{1.0, -1.0, 0.25});
    CHECK(light_of(json)["specularImages"].size() == 3);
    CHECK(light_of(json)["specularImages"][2][5] == 17);
    CHECK(json["images"].size() == 18);
    CHECK(json["images"][0]["uri"].get<std::string>().starts_with("data:image/png;base64,iVBORw0KGgo"));
}

TEST_CASE("gltf_image_light: intensity and rotation are read, and the scene's light is the one") {
    const TemporaryFolder folder;
    auto json = sample_json(folder);
    auto& lights = json["extensions"]["EXT_lights_image_based"]["lights"];
    lights.push_back(lights[0]);
    lights[1]["intensity"] = 2.5;
    lights[1]["rotation"] = {0, 1, 0, 0};
    json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
    const auto second = read(json.dump(), 1);
    REQUIRE(second);
    CHECK(second->intensity == 2.5);
    CHECK(second->rotation[1] == 1);
    CHECK(second->levels.size() == 1);
}

TEST_CASE("gltf_image_light: damaged files are errors that say what is wrong") {
    const TemporaryFolder folder;
    const auto json = sample_json(folder);
    const auto what = [&](auto change) {
        auto copy = json;
        change(copy, light_of(copy));
        const auto light = read(copy.dump());
        return light ? std::string() : light.error().what;
    };
    CHECK(what([](auto&, auto&) {}).empty());
    const auto contains = [](const std::string& text, const char* part) { return text.find(part) != text.npos; };
    CHECK(contains(what([](auto&, auto& l) { l.erase("specularImages"); }), "specularImages"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImages"][1] = {1, 2}; }), "not 6 numbers"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImages"][1][2] = 18; }), "no image 18"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImages"][1][2] = -1; }), "no image -1"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImages"][1][2] = 1.5; }), "no image 1.5"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImageSize"] = 24; }), "power of two"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImageSize"] = 2; }), "3 levels"));
    CHECK(contains(what([](auto&, auto& l) { l["specularImageSize"] = 16; }), "8 x 8 where 16 x 16"));
    CHECK(contains(what([](auto&, auto& l) { l["irradianceCoefficients"].erase(8); }), "8 of them"));
    CHECK(contains(what([](auto& j, auto&) { j["images"][4]["uri"] = "data:;base64,AAAA"; }), "level 0, face 4"));
    CHECK(contains(what([](auto& j, auto&) { j["images"][4]["uri"] = "../../etc/passwd"; }), "level 0, face 4"));
    CHECK(contains(what([](auto& j, auto&) { j["extensions"].erase("EXT_lights_image_based"); }), "no light"));
    CHECK(contains(what([](auto& j, auto&) { j["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1; }),
                   "light"));
}

TEST_CASE("gltf_image_light: a bake shows every direction's light, also when it is opened as an environment") {
    const TemporaryFolder folder;
    const ImageF image = direction_image(64);
    Environment environment = environment_of(image);
    BakeOptions options;
    options.engines = {"gltf"};
    options.size = 32;
    options.preview = false;
    options.threads = 2;
    REQUIRE(bake(environment, options, folder.path()));
    const auto opened = open_environment({folder / "sky.gltf"});
    REQUIRE(opened);
    CHECK(worst_direction(*opened->cube(), [](const Vec3d& d) { return d; }) < 0.03);
    CHECK(opened->world_to_source == Mat3{});
    const auto bytes = FileBytes::open(folder / "sky.gltf", 1 << 24);
    const auto light = read_gltf_image_light(*bytes, folder.path(), 1 << 28);
    REQUIRE(light);
    CHECK(light->levels.size() == 2);  // 32 and 16
    // E of 2 + d.n by hand: 2π + 2π / 3 n.
    for (const Vec3d& n : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, normalize(Vec3d{1, 2, 3})}) {
        const Vec3d e = sh_evaluate(light->irradiance, n);
        CHECK(e.x == doctest::Approx(2 * k_pi + 2 * k_pi / 3 * n.x).epsilon(1e-3));
        CHECK(e.z == doctest::Approx(2 * k_pi + 2 * k_pi / 3 * n.z).epsilon(1e-3));
    }
    // Half a turn about +Y: light from d now comes from the turned direction.
    auto json = nlohmann::json::parse((*bytes)->bytes().begin(), (*bytes)->bytes().end());
    light_of(json)["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};  // a quarter turn: +Z goes to +X
    light_of(json)["intensity"] = 2;
    const std::string text = json.dump();
    write_bytes(folder / "turned.gltf", {text.begin(), text.end()});
    const auto turned = open_environment({folder / "turned.gltf"});
    REQUIRE(turned);
    CHECK(length(turned->world_to_source * Vec3d{1, 0, 0} - Vec3d{0, 0, 1}) < 1e-6);
    CHECK(turned->cube()->face(2).at(5, 7)[0] == doctest::Approx(2 * opened->cube()->face(2).at(5, 7)[0]));
}
