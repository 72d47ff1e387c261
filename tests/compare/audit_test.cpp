#include "domelight/compare/bake_audit.h"
#include "domelight/projection/projection.h"
#include "domelight/base/random.h"

#include "compare/audit_fit.h"
#include "test.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

using namespace domelight;

namespace {

/// Light that no exchange of axes leaves alone: a gradient, soft lamps of different colours and one hard one.
ImageF environment(int height = 32) {
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const Vec3d d = latlong_direction({(x + 0.5) / (2 * height), (y + 0.5) / height});
            const auto lamp = [&](Vec3d at, double sharpness) {
                return std::exp(sharpness * (dot(normalize(at), d) - 1));
            };
            float* p = image.at(x, y);
            p[0] = float(0.3 + 0.1 * d.y + 5 * lamp({1, 0.3, 0.2}, 20) + 2 * lamp({-0.4, -0.2, 1}, 8));
            p[1] = float(0.3 + 0.1 * d.y + 3 * lamp({1, 0.3, 0.2}, 20) + 9 * lamp({-0.3, 0.8, -0.6}, 60));
            p[2] = float(0.3 + 0.2 * d.y + 1 * lamp({1, 0.3, 0.2}, 20) + 4 * lamp({0.1, -0.9, -0.5}, 12));
        }
    return image;
}

struct Wanted {
    int size;
    double roughness;
};

/// A chain baked with the light in direction `m` d of the environment for direction d.
std::vector<CubeLevel> bake(const ImageF& light, std::vector<Wanted> wanted, const Mat3& m = {}, float scale = 1) {
    FilterOptions options;
    options.world_to_source = m;
    options.sh_bands = 0;
    for (const Wanted& w : wanted)
        options.specular.push_back(w.roughness > 0 ? LevelSpec{w.size, false, ZonalKernel::ggx(w.roughness)}
                                                   : LevelSpec{w.size, true, {}});
    ImageRowSource rows(light.view());
    auto result = prefilter(rows, options);
    REQUIRE(bool(result));
    std::vector<CubeLevel> levels;
    for (FilteredMap& map : result->specular) {
        for (float& v : map.cube.pixels()) v *= scale;
        levels.push_back({std::move(map.cube), {}});
    }
    return levels;
}

const std::vector<Wanted> k_chain = {{32, 0}, {32, 0.37}, {16, 0.65}, {8, 1}};

AuditSource source_of(const ImageF& light) {
    AuditSource source;
    source.latlong = light.view();
    return source;
}

}  // namespace

TEST_SUITE("bake") {
    TEST_CASE("audit: our own bake is as ours, at the roughness it was baked with, to the prefilter's own accuracy") {
        const ImageF light = environment();
        std::vector<CubeLevel> levels = bake(light, k_chain);
        for (std::size_t l = 0; l < levels.size(); ++l) levels[l].roughness = k_chain[l].roughness;
        const auto audit = audit_bake(levels, source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->orientation.words == "as ours");
        CHECK(audit->orientation.certain);
        for (std::size_t l = 0; l < levels.size(); ++l) {
            CAPTURE(l);
            const LevelAudit& level = audit->levels[l];
            // The search ends on a parabola through points 0.01 apart: its minimum is good to a few 1e-4 of roughness.
            CHECK(std::abs(level.roughness - k_chain[l].roughness) < 1e-3);
            CHECK(level.roughness_known);
            CHECK(level.error < 1e-3);
            CHECK(level.relative_rmse < 1e-3);
            CHECK(std::abs(level.scale - 1) < 1e-3);
            CHECK(std::abs(level.energy - 1) < 1e-3);
            CHECK(level.stated_error < 1e-5);
        }
    }

    TEST_CASE("audit: a turned, mirrored and scaled bake is found to be that") {
        const ImageF light = environment();
        struct Case {
            Mat3 m;
            float scale;
            const char* words;
        };
        const auto turned = [](double degrees) { return rotation_y(degrees * k_pi / 180).transposed(); };
        const Mat3 mirror{{Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}};
        const Case cases[] = {{turned(90), 2.5f, "turned by 90 degrees about +Y"},
                              {turned(180), 1, "turned by 180 degrees about +Y"},
                              {mirror, 0.01f, "mirrored in x"},
                              {{{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}}}, 1, "mirrored in z"},
                              {{{Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}}, 1, "mirrored in y (upside down)"},
                              {mirror * turned(90), 1, "mirrored in x, then turned by 90 degrees about +Y"},
                              {{{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}}},
                               3,
                               "turned: its +X shows our +X, its +Y shows our -Z, its +Z shows our +Y"}};
        for (const Case& c : cases) {
            CAPTURE(c.words);
            const auto audit = audit_bake(bake(light, {{16, 0.5}}, c.m, c.scale), source_of(light), {.texels = 600});
            REQUIRE(bool(audit));
            CHECK(audit->orientation.words == c.words);
            CHECK(audit->orientation.next_error > 5 * audit->orientation.error);
            CHECK(std::abs(audit->levels[0].scale / c.scale - 1) < 1e-3);
            CHECK(std::abs(audit->levels[0].energy / c.scale - 1) < 2e-3);
            CHECK(std::abs(audit->levels[0].roughness - 0.5) < 1e-3);
            CHECK(audit->levels[0].error < 1e-3);
        }
    }

    TEST_CASE("audit: the rotation of the source is taken into account") {
        const ImageF light = environment();
        AuditSource source = source_of(light);
        source.world_to_source = rotation_y(0.7);
        const auto audit = audit_bake(bake(light, {{16, 0.5}}, rotation_y(0.7)), source);
        REQUIRE(bool(audit));
        CHECK(audit->orientation.words == "as ours");
        CHECK(audit->levels[0].error < 1e-3);
    }

    TEST_CASE("audit: a wrong roughness at the stated scale is seen as an error there, not in the fit") {
        const ImageF light = environment();
        std::vector<CubeLevel> levels = bake(light, {{16, 0.5}});
        levels[0].roughness = 0.7;
        const auto audit = audit_bake(levels, source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->levels[0].error < 1e-3);
        CHECK(audit->levels[0].stated_error > 0.05);
    }

    TEST_CASE("audit: even light tells neither orientation nor roughness") {
        const ImageF light(32, 16, 3, 0.5f);
        const auto audit = audit_bake(bake(light, {{8, 0.5}}), source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->orientation.words == "as ours");
        CHECK_FALSE(audit->orientation.certain);
        CHECK_FALSE(audit->levels[0].roughness_known);
    }

    TEST_CASE("audit: NaN texels are left out, black levels and no levels are errors") {
        const ImageF light = environment();
        std::vector<CubeLevel> levels = bake(light, {{16, 0.5}});
        for (int i = 0; i < 50; ++i)
            levels[0].cube.pixels()[std::size_t(31 * i)] = std::numeric_limits<float>::quiet_NaN();
        const auto audit = audit_bake(levels, source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->levels[0].error < 1e-3);
        CHECK_FALSE(audit_bake({}, source_of(light)));
        levels[0].cube = Cubemap(8);
        const auto black = audit_bake(levels, source_of(light));
        REQUIRE_FALSE(bool(black));
        CHECK(black.error().what.find("black") != std::string::npos);
    }

    TEST_CASE("audit: the same bits on one thread and on three") {
        const ImageF light = environment(16);
        const auto levels = bake(light, {{8, 0.6}});
        const auto one = audit_bake(levels, source_of(light), {.threads = 1}),
                   three = audit_bake(levels, source_of(light), {.threads = 3});
        REQUIRE(bool(one));
        REQUIRE(bool(three));
        CHECK(one->levels[0].roughness == three->levels[0].roughness);
        CHECK(one->levels[0].error == three->levels[0].error);
    }

    TEST_CASE("orientation_words: 48 orientations have 48 different names") {
        std::set<std::string> words;
        for (const Mat3& m : cube_orientations()) words.insert(orientation_words(m));
        CHECK(cube_orientations().size() == 48);
        CHECK(words.size() == 48);
    }
}
