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

/// What each sample of a finer cube reads of each texel: a lookup in cubes that have a 1 in one texel. Three texels at a
/// time, one in each channel. Columns of as many samples as the finer cube has texels.
std::vector<std::vector<double>> lookup_matrix(int size, int fine) {
    const std::size_t texels = std::size_t(6) * size * size;
    std::vector<std::vector<double>> columns(texels);
    for (std::size_t first = 0; first < texels; first += 3) {
        Cubemap ones(size);
        for (std::size_t c = 0; c < 3; ++c) ones.pixels()[3 * (first + c) + c] = 1;
        const BorderedCube bordered(ones);
        for (int k = 0; k < 6 * fine * fine; ++k) {
            const UV uv{(k % fine + 0.5) / fine, (k / fine % fine + 0.5) / fine};
            const Vec3f value = look_up(bordered, Vec3f(cube_direction(k / (fine * fine), uv)));
            columns[first].push_back(value.x);
            columns[first + 1].push_back(value.y);
            columns[first + 2].push_back(value.z);
        }
    }
    return columns;
}

/// Solves A x = b for a symmetric positive definite matrix, by Cholesky's decomposition.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
            a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return b;
}

/// The least of squared_error() that any texels have, negative ones too: dense least squares in double.
double least_squared_error(int size, const Cubemap& fine) {
    const int n = fine.size();
    const auto columns = lookup_matrix(size, n);
    const std::size_t texels = columns.size(), samples = columns[0].size();
    std::vector<double> angles(samples);
    for (std::size_t k = 0; k < samples; ++k) angles[k] = cube_solid_angle(int(k) % n, int(k) / n % n, n);
    std::vector<std::vector<double>> normal(texels, std::vector<double>(texels));
    for (std::size_t i = 0; i < texels; ++i)
        for (std::size_t k = 0; k < samples; ++k)
            if (columns[i][k] != 0)
                for (std::size_t j = 0; j <= i; ++j) normal[i][j] += angles[k] * columns[i][k] * columns[j][k];
    double least = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> gathered(texels);
        for (std::size_t i = 0; i < texels; ++i)
            for (std::size_t k = 0; k < samples; ++k)
                gathered[i] += angles[k] * columns[i][k] * fine.pixels()[3 * k + c];
        const auto x = solved(normal, gathered);
        // |R x - f|^2 = |f|^2 - x . R^T f where x solves the normal equations.
        for (std::size_t k = 0; k < samples; ++k) least += angles[k] * std::pow(fine.pixels()[3 * k + c], 2);
        for (std::size_t i = 0; i < texels; ++i) least -= x[i] * gathered[i];
    }
    return least;
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

    TEST_CASE("read texels: the error between the texels of a small level is the least that any texels have") {
        const ImageF light = lamp(0.5f);
        for (const auto& [size, roughness] : {std::pair{4, 1.0}, {8, 1.0}, {8, 0.6}}) {
            const Cubemap fine = level(light, size * read_texels_factor(size), roughness, Texels::centre);
            const double least = least_squared_error(size, fine),
                         ours = squared_error(read_texels(fine, size, 1), fine);
            INFO(size, " ", roughness);
            CHECK(ours > 0.999 * least);  // texels in float
            CHECK(ours < 1.01 * least);   // six steps of conjugate gradients
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
