#include "domelight/base/random.h"
#include "domelight/compare/bake_audit.h"
#include "domelight/projection/projection.h"

#include "compare/audit_fit.h"
#include "test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

using namespace domelight;

namespace {

/// Light that differs under every exchange of axes: a gradient, soft lamps of different colours and a hard one.
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

std::vector<CubeLevel> bake_levels(const ImageF& light, std::vector<LevelSpec> specs, const Mat3& m = {},
                                   float scale = 1) {
    FilterOptions options;
    options.world_to_source = m;
    options.sh_bands = 0;
    options.specular = std::move(specs);
    ImageRowSource rows(light.view());
    auto result = prefilter(rows, options);
    REQUIRE(bool(result));
    std::vector<CubeLevel> levels;
    for (FilteredMap& map : result->specular) {
        for (float& v : map.pixels()) v *= scale;
        levels.push_back({std::move(map).cube(), {}});
    }
    return levels;
}

/// A chain baked with the light in direction `m` d of the environment for direction d.
std::vector<CubeLevel> bake(const ImageF& light, std::vector<Wanted> wanted, const Mat3& m = {}, float scale = 1) {
    std::vector<LevelSpec> specs;
    for (const Wanted& w : wanted)
        specs.push_back(w.roughness > 0 ? LevelSpec{w.size, false, ZonalKernel::ggx(w.roughness)}
                                        : LevelSpec{w.size, true, {}});
    return bake_levels(light, specs, m, scale);
}

/// 0.05 to 20, different for each number.
float noise_of(std::ptrdiff_t i) {
    return std::exp(3 * float(std::sin(12.9898 * double(i) + 1)));
}

const std::vector<Wanted> k_chain = {{32, 0}, {32, 0.37}, {16, 0.65}, {8, 1}};

Environment source_of(const ImageF& light) {
    return Environment::from_latlong(light);
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
        Environment source = source_of(light);
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

    TEST_CASE("audit: the sampled texels hold the sun, and give the same means as all") {
        Cubemap cube(128);
        for (std::size_t i = 0; i < cube.pixels().size(); ++i) cube.pixels()[i] = 1 + 0.5F * float(i % 7);
        float* sun = cube.face(2).at(77, 31);
        sun[0] = sun[1] = sun[2] = 1e5F;
        const TexelSample some = sample_texels(cube, 6144), all = sample_texels(cube, 6 * 128 * 128);
        CHECK(some.texels.size() <= 6144);
        CHECK(all.texels.size() == 6 * 128 * 128);
        const auto sums = [](const TexelSample& sample) {
            std::array<double, 2> sum{};
            for (std::size_t k = 0; k < sample.weights.size(); ++k) {
                sum[0] += sample.weights[k];
                sum[1] += sample.weights[k] * sample.luminance[k];
            }
            return sum;
        };
        CHECK(sums(all)[0] == doctest::Approx(4 * k_pi));
        // The standard errors of about 4600 random texels are below 1 %; the sun alone is a third of the light.
        CHECK(sums(some)[0] == doctest::Approx(4 * k_pi).epsilon(0.03));
        CHECK(sums(some)[1] == doctest::Approx(sums(all)[1]).epsilon(0.03));
    }

    TEST_CASE("audit: a bake of another environment is refused") {
        const ImageF light = environment(64);
        ImageF other(light.width(), light.height(), 3);  // the same light, its columns in a shuffled order
        for (int y = 0; y < other.height(); ++y)
            for (int x = 0; x < other.width(); ++x)
                std::copy_n(light.at((13 * x + 5) % other.width(), other.height() - 1 - y), 3, other.at(x, y));
        std::vector<CubeLevel> levels = bake(other, k_chain);
        for (const bool stated : {false, true}) {
            CAPTURE(stated);
            for (std::size_t l = 0; l < levels.size(); ++l)
                levels[l].roughness = stated ? std::optional(k_chain[l].roughness) : std::nullopt;
            const auto audit = audit_bake(levels, source_of(light));
            REQUIRE(bool(audit));
            CHECK_FALSE(audit->of_source);
            CHECK_FALSE(audit->passed());
            CHECK(audit->verdict.starts_with("not a bake of this environment"));
            CHECK(audit->levels.size() == levels.size());
        }
    }

    TEST_CASE("audit: a level that fits nothing is told of as such where the others fit") {
        const ImageF light = environment(64);
        std::vector<CubeLevel> levels = bake(light, {{32, 0}, {16, 0.37}, {8, 0.65}});
        std::ptrdiff_t i = 0;
        for (float& v : levels[1].cube.pixels()) v *= noise_of(i++);
        const auto audit = audit_bake(levels, source_of(light));
        REQUIRE(bool(audit));
        CHECK_FALSE(audit->passed());
        CHECK(audit->verdict.find("level 1 is") != std::string::npos);
        CHECK(audit->verdict.find("or very noisy, because level 0 is only") != std::string::npos);
    }

    TEST_CASE("audit: roughnesses below the ladder's first are found, 0 among them") {
        ImageF light(256, 128, 3);
        for (std::size_t i = 0; i < light.pixels().size(); ++i)
            light.pixels()[i] = 0.2F + float(mix_bits(i) % 1000) / 1000;
        const std::vector<Wanted> wanted = {{128, 0}, {128, 0.1}, {64, 0.15}};
        const auto audit = audit_bake(bake(light, wanted), source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->of_source);
        for (std::size_t l = 0; l < wanted.size(); ++l) {
            CAPTURE(l);
            CHECK(std::abs(audit->levels[l].roughness - wanted[l].roughness) < 1e-3);
            CHECK(audit->levels[l].error < 2e-3);
        }
    }

    TEST_CASE("audit: a small first level that states its roughness gives the orientation") {
        const ImageF light = environment();
        std::vector<CubeLevel> levels = bake(light, {{8, 0.6}}, rotation_y(k_pi / 2).transposed());
        levels[0].roughness = 0.6;
        const auto audit = audit_bake(levels, source_of(light));
        REQUIRE(bool(audit));
        CHECK(audit->orientation.words == "turned by 90 degrees about +Y");
        CHECK(audit->levels[0].stated_error < 1e-5);
    }

    TEST_CASE("audit: our own bake passes, also by a limit above its error and not by one below") {
        const ImageF light = environment();
        std::vector<CubeLevel> levels = bake(light, k_chain);
        for (std::size_t l = 0; l < levels.size(); ++l) levels[l].roughness = k_chain[l].roughness;
        for (float& v : levels[2].cube.pixels()) v *= 1.1F;  // 9.1 % off at scale 1, exact in the fit
        const auto judged = [&](std::optional<double> within) {
            const auto audit = audit_bake(levels, source_of(light), {.within = within});
            REQUIRE(bool(audit));
            CHECK(audit->of_source);
            CHECK(audit->verdict.starts_with("a bake of this environment"));
            return *audit;
        };
        CHECK(judged({}).passed());
        CHECK(judged(0.1).passed());
        CHECK_FALSE(judged(0.08).passed());
        CHECK(judged(0.08).verdict.find("level 2") != std::string::npos);
    }

    TEST_CASE("audit: a Phong chain is audited as Phong, by its exponents") {
        const ImageF light = environment();
        const std::vector<double> exponents = {40, 7};
        std::vector<LevelSpec> specs = {{32, true, {}}};
        for (const double n : exponents) specs.push_back({16, false, {Lobe::phong_plain, n}});
        std::vector<CubeLevel> levels = bake_levels(light, specs);
        const auto audited = [&](Lobe lobe) {
            const auto audit = audit_bake(levels, source_of(light), {.lobe = lobe});
            REQUIRE(bool(audit));
            return *audit;
        };
        const BakeAudit found = audited(Lobe::phong_plain);
        CHECK(std::isinf(found.levels[0].exponent.value()));
        for (std::size_t l = 0; l < exponents.size(); ++l) {
            CAPTURE(l);
            // As for GGX the roughness is found to a few 1e-4; the relative error of the exponent is five times as
            // large.
            CHECK(std::abs(found.levels[l + 1].exponent.value() / exponents[l] - 1) < 0.01);
            CHECK(found.levels[l + 1].error < 1e-3);
            CHECK(audited(Lobe::ggx).levels[l + 1].error > 5 * found.levels[l + 1].error);
            levels[l + 1].exponent = exponents[l];
        }
        levels[0].exponent = std::numeric_limits<double>::infinity();
        const BakeAudit stated = audited(Lobe::phong_plain);
        for (const LevelAudit& level : stated.levels) CHECK(level.stated_error < 1e-5);
    }

    TEST_CASE("audit: a Charlie chain is audited as Charlie") {
        const ImageF light = environment();
        const std::vector<CubeLevel> levels =
            bake_levels(light, {{32, false, ZonalKernel::charlie(0.4)}, {16, false, ZonalKernel::charlie(0.8)}});
        const auto audit = audit_bake(levels, source_of(light), {.lobe = Lobe::charlie});
        REQUIRE(bool(audit));
        CHECK(audit->of_source);
        CHECK(std::abs(audit->levels[0].roughness - 0.4) < 2e-3);
        CHECK(std::abs(audit->levels[1].roughness - 0.8) < 2e-3);
        for (const LevelAudit& level : audit->levels) CHECK(level.error < 1e-3);
    }

    TEST_CASE("audit: a source with less detail than the bake is said to be too small") {
        ImageF large = environment(128);
        for (int y = 0; y < large.height(); ++y)  // stripes that are lost in the small picture
            for (int x = 0; x < large.width(); ++x)
                for (int c = 0; c < 3; ++c) large.at(x, y)[c] *= x % 4 < 2 ? 0.5F : 1.5F;
        ImageF small(64, 32, 3);
        for (int y = 0; y < large.height(); ++y)
            for (int x = 0; x < large.width(); ++x)
                for (int c = 0; c < 3; ++c) small.at(x / 4, y / 4)[c] += large.at(x, y)[c] / 16;
        const auto levels = bake(large, {{64, 0}, {16, 0.6}});
        const auto by_small = audit_bake(levels, source_of(small)), by_large = audit_bake(levels, source_of(large));
        REQUIRE(bool(by_small));
        REQUIRE(bool(by_large));
        CHECK(by_large->notes.empty());
        CHECK(by_small->of_source);
        REQUIRE(by_small->notes.size() == 1);
        CHECK(by_small->notes[0].find("too small for this bake") != std::string::npos);
    }

    TEST_CASE("audit: progress rises from 0 to 1 in many steps and may cancel") {
        const ImageF light = environment();
        const auto levels = bake(light, k_chain);
        AuditOptions options;
        double last = 0, widest = 0;
        options.progress = [&](std::string_view stage, double done) {
            CHECK(stage == "audit");
            CHECK(done >= last);
            widest = std::max(widest, done - last);
            last = done;
            return true;
        };
        REQUIRE(bool(audit_bake(levels, source_of(light), options)));
        CHECK(last == 1);
        CHECK(widest < 0.35);
        options.progress = [](std::string_view, double done) { return done < 0.3; };
        const auto cancelled = audit_bake(levels, source_of(light), options);
        REQUIRE_FALSE(bool(cancelled));
        CHECK(cancelled.error().what == "cancelled");
    }

    TEST_CASE("orientation_words: 48 orientations have 48 different names") {
        std::set<std::string> words;
        for (const Mat3& m : cube_orientations()) words.insert(orientation_words(m));
        CHECK(cube_orientations().size() == 48);
        CHECK(words.size() == 48);
    }
}
