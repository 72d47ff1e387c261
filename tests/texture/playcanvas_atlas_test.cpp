#include "texture/container/playcanvas_atlas.h"

#include "domelight/bake/bake.h"

#include "filtering/resample/resize_latlong.h"
#include "io/io_helpers.h"
#include "io/picture/png_memory.h"
#include "oriented.h"
#include "test.h"
#include "texture/texel/rgba8_ranges.h"

#include <cmath>
#include <vector>

using namespace domelight;
using namespace domelight::test;

namespace {

std::vector<AtlasRect> all_rects() {
    std::vector<AtlasRect> rects{k_atlas_diffuse_rect};
    for (int l = 0; l < k_atlas_shiny_levels; ++l) rects.push_back(atlas_shiny_rect(l));
    for (int l = 1; l <= k_atlas_rough_levels; ++l) rects.push_back(atlas_rough_rect(l));
    return rects;
}

/// PlayCanvas' shader (envAtlas, spherical and reflectionEnv chunks): where it looks in a rectangle for a direction, in
/// texels of the atlas.
UV shader_lookup(const Vec3d& d, double x, double y, double width, double height) {
    const double u = std::atan2(-d.x, d.z) / (2 * k_pi) + 0.5, v = 1 - (std::asin(d.y) / k_pi + 0.5);
    return {x + 1 + u * (width - 2), y + 1 + v * (height - 2)};
}

/// Bilinear, as a sampler reads; RGBP decoded first.
Vec3d sample(const Image<std::uint8_t>& atlas, UV at) {
    const double px = at.u - 0.5, py = at.v - 0.5;
    const int x0 = int(std::floor(px)), y0 = int(std::floor(py));
    Vec3d sum;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const std::uint8_t* p = atlas.at(std::clamp(x0 + i, 0, 511), std::clamp(y0 + j, 0, 511));
            const Vec3f v = rgb_from_rgbp({p[0], p[1], p[2], p[3]});
            sum += Vec3d(v) * ((i ? px - x0 : 1 - (px - x0)) * (j ? py - y0 : 1 - (py - y0)));
        }
    return sum;
}

}  // namespace

TEST_CASE("playcanvas_atlas: the places are those of its shader, and none overlaps another") {
    for (int l = 0; l < k_atlas_shiny_levels; ++l) {
        const double t = 1 / std::exp2(l);  // mapShinyUv
        const AtlasRect r = atlas_shiny_rect(l);
        CHECK(r.x == 512 * (1 - t));
        CHECK(r.y == 512 * (1 - t));
        CHECK(r.width == 512 * t);
        CHECK(r.height == 256 * t);
    }
    for (int l = 1; l <= k_atlas_rough_levels; ++l) {
        const double t = 1 / std::exp2(l);  // mapRoughnessUv
        const AtlasRect r = atlas_rough_rect(l);
        CHECK(r.x == 0);
        CHECK(r.y == 512 * (1 - t));
        CHECK(r.width == 512 * t);
        CHECK(r.height == 256 * t);
    }
    Image<std::uint8_t> used(512, 512, 1);
    for (const AtlasRect& r : all_rects())
        for (int y = r.y; y < r.y + r.height; ++y)
            for (int x = r.x; x < r.x + r.width; ++x) ++*used.at(x, y);
    CHECK(*std::max_element(used.pixels().begin(), used.pixels().end()) == 1);
}

TEST_CASE("resize_latlong: power is kept, a constant stays constant, means are those of the texels covered") {
    const ImageF image = direction_image(32);
    const auto mean = [](const ImageF& m, int c) {
        double sum = 0;
        for (int y = 0; y < m.height(); ++y)
            for (int x = 0; x < m.width(); ++x)
                sum += double(m.at(x, y)[c]) * latlong_solid_angle(y, m.width(), m.height());
        return sum / (4 * k_pi);
    };
    for (const auto& [width, height] : {std::pair{30, 14}, {62, 30}, {6, 2}, {64, 32}, {1, 1}}) {
        const ImageF small = resize_latlong(image.view(), width, height);
        for (int c = 0; c < 3; ++c) CHECK(mean(small, c) == doctest::Approx(mean(image, c)).epsilon(1e-6));
    }
    ImageF constant(16, 8, 3);
    std::fill(constant.pixels().begin(), constant.pixels().end(), 3.5f);
    const ImageF resized = resize_latlong(constant.view(), 6, 5);
    for (const float v : resized.pixels()) CHECK(v == doctest::Approx(3.5f).epsilon(1e-6));
    // Two by two texels, weighted by the solid angles of their rows.
    const ImageF half = resize_latlong(image.view(), 32, 16);
    const double w0 = latlong_solid_angle(2, 64, 32), w1 = latlong_solid_angle(3, 64, 32);
    const double expected = ((double(image.at(8, 2)[0]) + double(image.at(9, 2)[0])) * w0 +
                             (double(image.at(8, 3)[0]) + double(image.at(9, 3)[0])) * w1) /
                            (2 * (w0 + w1));
    CHECK(half.at(4, 1)[0] == doctest::Approx(expected).epsilon(1e-6));
}

TEST_CASE("playcanvas_atlas: every level shows every direction where the shader looks, across all seams") {
    const ImageF image = direction_image(64);
    const std::vector<FilteredMap> maps(7, FilteredMap(Layout::latlong, image));
    // PlayCanvas' convention: the centre is +Z, right of it -X.
    const Image<std::uint8_t> atlas = make_playcanvas_atlas(maps, maps[0], TexelOrder::of_latlong(1), 1);
    for (const AtlasRect& r : all_rects()) {
        if (r.width < 16) continue;
        double worst = 0;
        for (int i = 0; i < 500; ++i) {
            // Spread over the sphere, both poles and the seam behind included.
            const double z = 1 - 2 * (i + 0.5) / 500, phi = i * 2.399963, s = std::sqrt(1 - z * z);
            const Vec3d d = i == 0   ? Vec3d{0, 1, 0}
                            : i == 1 ? Vec3d{0, -1, 0}
                            : i == 2 ? normalize(Vec3d{1e-6, 0.1, -1})
                                     : Vec3d{s * std::cos(phi), z, s * std::sin(phi)};
            worst = std::max(worst,
                             length(sample(atlas, shader_lookup(d, r.x, r.y, r.width, r.height)) - Vec3d{2, 2, 2} - d));
        }
        // Bilinear between texels 2π / width apart, and some steps of the encoding.
        CHECK(worst < 1.5 * std::pow(2 * k_pi / r.width, 2) + 0.03);
    }
}

TEST_CASE("playcanvas_atlas: bake writes it, and a furnace stays constant in all of it") {
    const TemporaryFolder folder;
    ImageF furnace(64, 32, 3);
    std::fill(furnace.pixels().begin(), furnace.pixels().end(), 0.75f);
    Environment environment = environment_of(furnace);
    BakeOptions options;
    options.engines = {"playcanvas"};
    options.preview = false;
    options.threads = 2;
    const auto report = bake(environment, options, folder.path());
    REQUIRE(report);
    REQUIRE(report->engines[0].maps.size() == 1);
    CHECK(report->engines[0].maps[0].levels.size() == 7);
    CHECK(report->engines[0].maps[0].levels[3].roughness == doctest::Approx(0.6));
    const auto maps = read_playcanvas_atlas(folder / "sky-env-atlas.png");
    REQUIRE(maps);
    REQUIRE(maps->shiny.size() == 7);
    REQUIRE(maps->rough.size() == 6);
    std::vector<const ImageF*> all{&maps->diffuse};
    for (const ImageF& map : maps->shiny) all.push_back(&map);
    for (const ImageF& map : maps->rough) all.push_back(&map);
    for (const ImageF* map : all)
        for (const float v : map->pixels()) CHECK(std::abs(v - 0.75f) < 0.004f);
}

TEST_CASE("playcanvas_atlas: other pictures are refused") {
    Image<std::uint8_t> small(256, 256, 4);
    const auto png = encode_png(small.view());
    REQUIRE(png);
    const auto maps = playcanvas_atlas(*png);
    REQUIRE_FALSE(maps);
    CHECK(maps.error().what.find("256 x 256") != std::string::npos);
    CHECK_FALSE(playcanvas_atlas(std::span(*png).first(100)));
}
