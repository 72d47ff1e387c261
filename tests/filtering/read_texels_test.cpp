#include "filtering/read_texels.h"

#include "domelight/filtering/prefilter.h"
#include "domelight/projection/projection.h"

#include "projection/bilinear.h"
#include "test.h"

#include <algorithm>
#include <cmath>

using namespace domelight;

namespace {

/// A lamp of one texel in front of a dark gradient, or of black.
ImageF lamp(float background) {
    constexpr int height = 32;
    ImageF image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = background * float(1 + c + y);
    std::fill_n(image.at(9, 11), 3, 500.f);
    return image;
}

FilterResult filtered(const ImageF& light, std::vector<LevelSpec> levels, Texels texels, int threads = 0,
                      Layout layout = Layout::cube) {
    FilterOptions options;
    options.specular = std::move(levels);
    options.texels = texels;
    options.layout = layout;
    options.irradiance_size = 16;
    options.threads = threads;
    auto result = prefilter(Environment::from_latlong(light), options);
    REQUIRE(bool(result));
    return *std::move(result);
}

bool same_pixels(const FilteredMap& a, const FilteredMap& b) {
    return std::ranges::equal(a.pixels(), b.pixels());
}

/// ∑ ω |lookup − light|² over the texels of a finer cube.
double squared_error(const Cubemap& cube, const Cubemap& fine) {
    const BorderedCube bordered(cube);
    const int n = fine.size();
    double sum = 0;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Vec3f value = look_up(bordered, Vec3f(cube_direction(f, {(x + 0.5) / n, (y + 0.5) / n})));
                const float* p = fine.face(f).at(x, y);
                const Vec3d error = Vec3d(value) - Vec3d{p[0], p[1], p[2]};
                sum += cube_solid_angle(x, y, n) * dot(error, error);
            }
    return sum;
}

Cubemap level(const ImageF& light, int size, double roughness, Texels texels) {
    return filtered(light, {{size, false, ZonalKernel::ggx(roughness)}}, texels).specular[0].cube();
}

}  // namespace

TEST_SUITE("filtering") {
    TEST_CASE("read texels: a constant stays constant") {
        ImageF image(32, 16, 3);
        std::ranges::fill(image.pixels(), 3.f);
        for (const int size : {1, 2, 7, 16, 64}) {
            const Cubemap cube = level(image, size, 0.8, Texels::read);
            for (const float value : cube.pixels()) CHECK(value == doctest::Approx(3).epsilon(1e-5));  // float
        }
    }

    TEST_CASE("read texels: no other texels of a small level are nearer to the light between them") {
        const ImageF light = lamp(0.02f);
        for (const int size : {4, 9, 16}) {
            const Cubemap fine = level(light, size * read_texels_factor(size), 0.7, Texels::centre);
            Cubemap cube = read_texels(fine, size, 1);
            const double least = squared_error(cube, fine);
            for (std::size_t i = 0; i < cube.pixels().size(); i += 97)
                for (const float step : {-0.02f, 0.02f}) {
                    const float before = cube.pixels()[i];
                    cube.pixels()[i] += step * before;
                    CHECK(squared_error(cube, fine) > least);
                    cube.pixels()[i] = before;
                }
        }
    }

    TEST_CASE("read texels: what is read between texels is nearer to the light, at every size") {
        const ImageF light = lamp(0.02f);
        for (const auto& [size, roughness] : {std::pair{8, 1.0}, {16, 0.6}, {33, 0.4}, {64, 0.3}}) {
            const Cubemap fine = level(light, 5 * size, roughness, Texels::centre);
            const double centre = squared_error(level(light, size, roughness, Texels::centre), fine),
                         read = squared_error(level(light, size, roughness, Texels::read), fine);
            INFO(size, " ", roughness);
            // Taking away the mean of the error between texels leaves a sixth of a parabola's square (docs/math/prefilter.md)
            CHECK(read < 0.4 * centre);
        }
    }

    TEST_CASE("read texels: light that is black is not made negative") {
        for (const int size : {8, 32, 64}) {
            const Cubemap cube = level(lamp(0), size, 0.9, Texels::read);
            CHECK(*std::ranges::min_element(cube.pixels()) >= 0);
        }
    }

    TEST_CASE("read texels: the bytes are the same on any number of threads") {
        const std::vector<LevelSpec> levels{{64, false, ZonalKernel::ggx(0.3)}, {16, false, ZonalKernel::ggx(0.8)}};
        const auto one = filtered(lamp(0.1f), levels, Texels::read, 1),
                   three = filtered(lamp(0.1f), levels, Texels::read, 3);
        for (std::size_t l = 0; l < 2; ++l) CHECK(same_pixels(one.specular[l], three.specular[l]));
    }

    TEST_CASE("read texels: mirrors, narrow lobes, lat-long maps and irradiance hold what is at texel centres") {
        const ImageF light = lamp(0.1f);
        const std::vector<LevelSpec> levels{{32, true, {}}, {16, false, ZonalKernel::ggx(0.15)}};
        const auto centre = filtered(light, levels, Texels::centre), read = filtered(light, levels, Texels::read);
        CHECK(same_pixels(centre.specular[0], read.specular[0]));
        CHECK(same_pixels(centre.specular[1], read.specular[1]));
        CHECK(same_pixels(centre.irradiance_over_pi, read.irradiance_over_pi));
        const std::vector<LevelSpec> wide{{16, false, ZonalKernel::ggx(0.8)}};
        CHECK(!same_pixels(filtered(light, wide, Texels::centre).specular[0],
                           filtered(light, wide, Texels::read).specular[0]));
        CHECK(same_pixels(filtered(light, wide, Texels::centre, 0, Layout::latlong).specular[0],
                          filtered(light, wide, Texels::read, 0, Layout::latlong).specular[0]));
    }
}
