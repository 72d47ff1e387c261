#include "bake/panorama.h"

#include "domelight/bake/bake.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projections.h"
#include "domelight/texture/texture.h"

#include "oriented.h"
#include "projection/convention_text.h"
#include "test.h"

#include <fmt/core.h>

#include <cmath>
#include <tuple>

using namespace domelight;
using namespace domelight::test;

namespace {

/// The largest distance between what the texels of a projected picture of directions hold and their own directions.
double worst_of(const ImageF& image, const char* name) {
    const Projection projection = *projection_from_name(name);
    double worst = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const UVBox box = projection.texel_box(x, y, image.width(), image.height());
            const Vec3d d = projection.direction(0, {(box.u0 + box.u1) / 2, (box.v0 + box.v1) / 2});
            worst = std::max(worst, length(direction_of(image.at(x, y)) - d));
        }
    return worst;
}

}  // namespace

TEST_CASE("panorama_spec: width follows from the projection; panorama_like keeps a lat-long source's size") {
    CHECK(panorama_spec("latlong/usd", 64) == PanoramaSpec{"latlong/usd", 128, 64});
    CHECK(panorama_spec("pbrt", 64) == PanoramaSpec{"pbrt", 64, 64});
    const ImageF image = direction_image(64);
    const Environment environment = environment_of(image);
    CHECK(panorama_like(environment, "latlong/mitsuba") == PanoramaSpec{"latlong/mitsuba", 128, 64});
}

TEST_CASE("panorama_as_latlong: every direction lies where the default convention says, and no finer than asked for") {
    const ImageF image = direction_image(64);
    const ImageF shown = panorama_as_latlong(image, "latlong", 32, 1);
    CHECK(shown.height() == 32);
    CHECK(worst_of(shown, "latlong") < 0.06);  // means over texels 0.1 wide, compared with the values at their centres
    CHECK(panorama_as_latlong(image, "latlong", 512, 1).height() == 64);
}

TEST_CASE("bake: engines of both layouts share one reading, and each gets what it would alone") {
    const TemporaryFolder folder;
    const ImageF image = direction_image(32);
    BakeOptions options;
    options.size = 16;
    options.levels = 3;
    options.irradiance_size = 8;
    options.brdf_size = 8;
    options.preview = false;
    options.threads = 2;
    const auto run = [&](std::vector<std::string> engines, const char* name) {
        Environment environment = environment_of(image);
        options.engines = std::move(engines);
        REQUIRE(bake(environment, options, folder / name));
    };
    run({"generic", "materialx"}, "both");
    run({"materialx"}, "alone");
    run({"generic"}, "cube");
    const auto both = read_texture(folder / "both/generic/specular.ktx2"),
               cube = read_texture(folder / "cube/specular.ktx2");
    REQUIRE(both);
    REQUIRE(cube);
    CHECK(both->levels == cube->levels);
    const auto first = open_environment({folder / "both/materialx/sky.exr"}, {.latlong = "materialx"}),
               second = open_environment({folder / "alone/sky.exr"}, {.latlong = "materialx"});
    REQUIRE(first);
    REQUIRE(second);
    const auto a = read_latlong(**first->rows()), b = read_latlong(**second->rows());
    REQUIRE(a);
    REQUIRE(b);
    CHECK(std::equal(a->pixels().begin(), a->pixels().end(), b->pixels().begin()));
    for (const Vec3d& d : {Vec3d{1, 0.1, 0.2}, Vec3d{0.1, 0.2, -1}, Vec3d{-0.3, 1, 0.1}}) {
        const UV uv = latlong_uv(first->world_to_source * d);
        CHECK(length(direction_of(texel_at(*a, uv.u, uv.v)) - normalize(d)) < 0.15);
    }
}

TEST_CASE("bake: engines that take the environment alone get it in their own convention") {
    const std::pair<const char*, const char*> engines[] = {
        {"three-latlong", "default"}, {"blender", "default"}, {"godot", "usd"}, {"usd", "usd"},
        {"mitsuba", "mitsuba"},       {"pbrt", "pbrt"}};
    for (const auto& [engine, convention] : engines) {
        const TemporaryFolder folder;
        const ImageF image = direction_image(64);
        Environment environment = environment_of(image);
        BakeOptions options;
        options.engines = {engine};
        options.size = 32;
        options.irradiance_size = 8;
        options.preview = false;
        const auto report = bake(environment, options, folder.path());
        REQUIRE(report);
        CHECK(report->engines[0].maps[0].role == "environment");
        EnvironmentOptions reading;
        reading.latlong = convention;
        auto opened = open_environment({folder / "sky.exr"}, reading);
        REQUIRE(opened);
        REQUIRE_FALSE(opened->cube());
        const auto read = read_latlong(**opened->rows());
        REQUIRE(read);
        for (const Vec3d& d : {Vec3d{1, 0.2, 0.1}, Vec3d{-1, -0.5, 0.3}, Vec3d{0.1, 1, 1}, Vec3d{0.2, 0.3, -1}}) {
            const UV uv = latlong_uv(opened->world_to_source * d);
            CHECK(length(direction_of(texel_at(*read, uv.u, uv.v)) - normalize(d)) < 0.15);
        }
    }
}

TEST_CASE("bake: an image for an engine that filters by itself is as large as its source") {
    const std::tuple<const char*, const char*, int> engines[] = {{"blender", "default", 2},
                                                                 {"godot", "usd", 2},
                                                                 {"usd", "usd", 2},
                                                                 {"mitsuba", "mitsuba", 2},
                                                                 {"pbrt", "pbrt", 1}};
    for (const int height : {24, 512})
        for (const auto& [engine, convention, aspect] : engines) {
            CAPTURE(engine);
            const TemporaryFolder folder;
            const ImageF image = direction_image(height);
            Environment environment = environment_of(image);
            BakeOptions options;
            options.engines = {engine};
            options.irradiance_size = 8;
            options.preview = false;
            const auto report = bake(environment, options, folder.path());
            REQUIRE(report);
            const auto opened = open_environment({folder / "sky.exr"}, {.latlong = convention});
            REQUIRE(opened);
            CHECK(opened->width == opened->height * aspect);
            CHECK(opened->height == height);
            const BakedLevel& level = report->engines[0].maps[0].levels.front();
            CHECK(level.size == opened->height);
            CHECK(level.width == opened->width);
            CHECK(report->engines[0].manifest.find("\"size_of_source\": true") != std::string::npos);
            CHECK(report->engines[0].manifest.find(fmt::format("\"size\": {}", opened->height)) != std::string::npos);
        }
}

TEST_CASE("bake: an image that only changes its convention keeps its texels") {
    const ImageF image = direction_image(32);
    for (const char* convention : {"default", "usd"}) {
        const TemporaryFolder folder;
        Environment environment = environment_of(image);
        BakeOptions options;
        options.engines = {std::string(convention) == "usd" ? "usd" : "blender"};
        options.encoding = Encoding::rgba32f;
        options.irradiance_size = 8;
        options.preview = false;
        REQUIRE(bake(environment, options, folder.path()));
        const auto opened = open_environment({folder / "sky.exr"}, {.latlong = convention});
        REQUIRE(opened);
        const auto read = read_latlong(**opened->rows());
        REQUIRE(read);
        const int quarter = std::string(convention) == "usd" ? 16 : 0;  // columns from +X to +Z
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x) CHECK(read->at(x, y)[0] == image.at((x + quarter) % 64, y)[0]);
    }
}

TEST_CASE("bake: unity and unreal get a cube as they look it up, and a lat-long image for their importers") {
    const ImageF image = direction_image(64);
    for (const char* engine : {"unity", "unreal"}) {
        const TemporaryFolder folder;
        Environment environment = environment_of(image);
        BakeOptions options;
        options.engines = {engine};
        options.size = 32;
        options.irradiance_size = 8;
        options.preview = false;
        REQUIRE(bake(environment, options, folder.path()));
        const auto texture = read_texture(folder / "sky.dds");
        REQUIRE(texture);
        const auto cubes = decode_cubes(*texture);
        REQUIRE(cubes);
        const bool unity = std::string(engine) == "unity";
        CHECK(worst_direction(cubes->front(), [&](const Vec3d& d) {
                  return unity ? Vec3d{-d.x, d.y, d.z} : Vec3d{d.x, d.z, d.y};
              }) < 0.01);
        auto opened = open_environment({folder / "sky_latlong.exr"}, {.latlong = unity ? "usd" : "materialx"});
        REQUIRE(opened);
        CHECK(opened->width == 256);  // 4 N texels round for faces of N^2
        const auto read = read_latlong(**opened->rows());
        REQUIRE(read);
        const UV uv = latlong_uv(opened->world_to_source * Vec3d{1, 0.2, 0.1});
        CHECK(direction_of(texel_at(*read, uv.u, uv.v)).x > 0.9);
    }
}

TEST_CASE("bake: everything lat-long lies in the convention that is asked for, and the manifest names it") {
    const ImageF image = direction_image(64);
    const auto baked = [&](const std::string& engine, Container format, const std::string& convention,
                           const TemporaryFolder& folder) {
        BakeOptions options;
        options.engines = {engine};
        if (engine == "generic") options.layout = Layout::latlong;
        options.size = engine == "unity" ? 16 : 32;
        options.levels = 1;
        options.latlong_out = convention;
        if (engine != "unity") options.format = format;
        options.irradiance_size = 8;
        options.preview = false;
        const auto report = bake(environment_of(image), options, folder.path());
        REQUIRE(report);
        const std::string& manifest = report->engines[0].manifest;
        CHECK(manifest.find("\"latlong_out\": \"" + convention + "\"") != std::string::npos);
        CHECK(manifest.find("\"projection\": \"latlong/" + convention + "\"") != std::string::npos);
        CHECK(manifest.find(projection_convention("latlong/" + convention)) != std::string::npos);
    };
    const std::tuple<const char*, Container, const char*> files[] = {
        {"generic", Container::exr, "specular.exr"}, {"generic", Container::exr_mip, "specular.exr"},
        {"generic", Container::hdr, "specular.hdr"}, {"blender", Container::exr, "sky.exr"},
        {"usd", Container::hdr, "sky.hdr"},          {"materialx", Container::exr_mip, "sky.exr"},
        {"unity", Container::dds, "sky_latlong.exr"}};
    for (const char* convention : {"usd", "mitsuba", "openexr", "materialx", "mod", "centre=-Y,right=+X,up=+Z",
                                   "centre=+X,right=-Z"})  // the last one mirrors
        for (const auto& [engine, format, file] : files) {
            INFO(convention << ", " << engine << ", " << name_of(format));
            const TemporaryFolder folder;
            baked(engine, format, convention, folder);
            const auto opened = open_environment({folder / file}, {.projection = "latlong", .latlong = convention});
            REQUIRE(opened);
            for (const Vec3d& d : {Vec3d{1, 0.2, 0.1}, Vec3d{-1, -0.5, 0.3}, Vec3d{0.1, 1, 1}, Vec3d{0.2, 0.3, -1}}) {
                const auto radiance = opened->radiance(d);
                REQUIRE(radiance);
                CHECK(length(direction_of(&radiance->x) - normalize(d)) < 0.15);
            }
        }
}

TEST_CASE("bake: OpenEXR's attribute stands where samples lie as it says, and nowhere else") {
    const ImageF image = direction_image(64);
    const auto opened = [&](std::optional<std::string> convention, Container format) {
        const TemporaryFolder folder;
        BakeOptions options;
        options.layout = Layout::latlong;
        options.size = 32;
        options.levels = 1;
        options.format = format;
        options.latlong_out = std::move(convention);
        options.preview = false;
        REQUIRE(bake(environment_of(image), options, folder.path()));
        // Read without a word about its convention.
        const auto read = open_environment({folder / "specular.exr"});
        REQUIRE(read);
        return length(direction_of(&read->radiance({1, 0.2, 0.1})->x) - normalize(Vec3d{1, 0.2, 0.1})) < 0.15;
    };
    CHECK(opened({}, Container::exr_mip));  // OpenEXR's own convention
    CHECK(opened("openexr", Container::exr_mip));
    CHECK(opened("openexr", Container::exr));
    CHECK(opened("default", Container::exr_mip));
    CHECK_FALSE(opened("mitsuba", Container::exr_mip));
    CHECK_FALSE(opened("usd", Container::exr_mip));
}
