#include "domelight/filtering/resample/area_resample.h"

#include "domelight/projection/projection.h"

#include "base/instruction_set.h"
#include "filtering/resample/area_resample_cube.h"
#include "filtering/resample/area_resample_plain.h"
#include "test.h"

#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace domelight;

namespace {

const Mat3 k_identity{};
const Mat3 k_z_up{{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}}};
const Mat3 k_mirror{{Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}};

/// An arbitrary rotation: about the axis (1, 2, 3) by 0.7 radians.
Mat3 tilted() {
    const Vec3d k = normalize(Vec3d{1, 2, 3});
    const double c = std::cos(0.7), s = std::sin(0.7);
    const auto row = [&](Vec3d e) { return e * c + cross(e, k) * s + k * (dot(k, e) * (1 - c)); };
    return {{row({1, 0, 0}), row({0, 1, 0}), row({0, 0, 1})}};
}

ImageF random_image(int width, int height, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    ImageF image(width, height, 3);
    for (float& p : image.pixels()) p = uniform(random) * (uniform(random) < 0.1f ? 100 : 1);
    return image;
}

/// The definition of the source: bilinear between texel centres, u wraps, v clamps.
Vec3d bilinear(ImageView<const float> image, UV uv) {
    const double x = uv.u * image.width - 0.5, y = uv.v * image.height - 0.5;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const auto texel = [&](int column, int row) {
        const float* p =
            image.at(((column % image.width) + image.width) % image.width, std::clamp(row, 0, image.height - 1));
        return Vec3d(p[0], p[1], p[2]);
    };
    const double s = x - i, t = y - j;
    return (texel(i, j) * (1 - s) + texel(i + 1, j) * s) * (1 - t) +
           (texel(i, j + 1) * (1 - s) + texel(i + 1, j + 1) * s) * t;
}

/// ∫ g dω over the sphere: the integral of each row's tent against sin θ in closed form.
Vec3d total_light(ImageView<const float> image) {
    const double h = k_pi / image.height;
    Vec3d sum;
    for (int y = 0; y < image.height; ++y) {
        const bool polar = y == 0 || y + 1 == image.height;
        const double tent = image.height == 1 ? 2
                            : polar           ? 1 - (std::sin(1.5 * h) - std::sin(0.5 * h)) / h
                                              : 4 * std::sin((y + 0.5) * h) * std::pow(std::sin(0.5 * h), 2) / h;
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            sum += Vec3d(p[0], p[1], p[2]) * (tent * 2 * k_pi / image.width);
        }
    }
    return sum;
}

ImageF resample_to_cube(ImageView<const float> image, int size, const Mat3& m, int threads = 1, int chunk = 0) {
    auto resampler = area_resample_to_cube(image.width, image.height, size, m, threads);
    if (chunk <= 0) chunk = image.height;
    for (int y = 0; y < image.height; y += chunk) resampler->add_rows(image.rows(y, std::min(chunk, image.height - y)));
    return resampler->finish();
}

ImageF resample_to_latlong(ImageView<const float> image, int height, const Mat3& m, int threads = 1, int chunk = 0) {
    auto resampler = area_resample_to_latlong(image.width, image.height, height, m, threads);
    if (chunk <= 0) chunk = image.height;
    for (int y = 0; y < image.height; y += chunk) resampler->add_rows(image.rows(y, std::min(chunk, image.height - y)));
    return resampler->finish();
}

Vec3d cube_light(ImageView<const float> strip) {
    const int n = strip.width;
    Vec3d sum;
    for (int y = 0; y < 6 * n; ++y)
        for (int x = 0; x < n; ++x) {
            const float* p = strip.at(x, y);
            sum += Vec3d(p[0], p[1], p[2]) * cube_solid_angle(x, y % n, n);
        }
    return sum;
}

Vec3d latlong_light(ImageView<const float> image) {
    Vec3d sum;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            sum += Vec3d(p[0], p[1], p[2]) * latlong_solid_angle(y, image.width, image.height);
        }
    return sum;
}

/// A constant with a different value in each channel: results are clamped to the range of all values, and this must not
/// hide an error.
constexpr float k_constant[3] = {0.7f, 0.2f, 3.0f};

double worst_against_constant(std::span<const float> pixels) {
    double worst = 0;
    for (std::size_t k = 0; k < pixels.size(); k += 3)
        worst = std::max(worst, std::abs(pixels[k] / double(k_constant[0]) - 1));
    return worst;
}

void fill_constant(std::span<float> pixels) {
    for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = k_constant[k % 3];
}

double relative(const Vec3d& a, const Vec3d& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) /
           std::max({b.x, b.y, b.z, 1e-300});
}

/// A texel's average by steps^2 samples, each weighed by its own solid angle.
Vec3d sampled_cube_texel(ImageView<const float> image, int face, int x, int y, int size, const Mat3& m, int steps) {
    Vec3d sum;
    double weight = 0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const Vec3d d = cube_direction(face, {(x + (i + 0.5) / steps) / size, (y + (j + 0.5) / steps) / size});
            const double w = std::pow(dot(d, d), -1.5);
            sum += bilinear(image, latlong_uv(m * d)) * w;
            weight += w;
        }
    return sum / weight;
}

Vec3d sampled_latlong_texel(ImageView<const float> image, int x, int y, int height, const Mat3& m, int steps) {
    Vec3d sum;
    double weight = 0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const UV uv{(x + (i + 0.5) / steps) / (2 * height), (y + (j + 0.5) / steps) / height};
            const double w = std::sin(k_pi * uv.v);
            sum += bilinear(image, latlong_uv(m * latlong_direction(uv))) * w;
            weight += w;
        }
    return sum / weight;
}

struct Shape {
    int width, height, size;
};

}  // namespace

TEST_CASE("area_resample: cube texels are the average of the bilinear reconstruction") {
    std::mt19937 random(7);
    for (const Shape s : {Shape{1, 1, 2},
                          {3, 2, 1},
                          {3, 2, 4},
                          {5, 3, 3},
                          {8, 4, 5},
                          {64, 32, 16},
                          {64, 32, 4},
                          {37, 19, 8},
                          {16, 8, 1}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), k_z_up, k_mirror, tilted()}) {
            const ImageF image = random_image(s.width, s.height);
            const ImageF cube = resample_to_cube(image, s.size, m);
            double worst = 0;
            for (int k = 0; k < 6; ++k) {
                const int x = random() % s.size, y = random() % (6 * s.size);
                const Vec3d truth =
                    sampled_cube_texel(image, y / s.size, x, y % s.size, s.size, m, s.width > 8 * s.size ? 700 : 300);
                const float* p = cube.at(x, y);
                worst = std::max(worst, relative(Vec3d(p[0], p[1], p[2]), truth));
            }
            INFO(s.width, "x", s.height, " to ", s.size);
            CHECK(worst < 1e-4);  // the error of the samples, O(1/steps²) at the kinks of the reconstruction
        }
}

TEST_CASE("area_resample: lat-long texels are the average of the bilinear reconstruction") {
    std::mt19937 random(8);
    for (const Shape s : {Shape{1, 1, 1}, {3, 2, 2}, {5, 3, 3}, {64, 32, 16}, {37, 19, 40}, {16, 8, 1}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), k_z_up, k_mirror, tilted()}) {
            const ImageF image = random_image(s.width, s.height);
            const ImageF out = resample_to_latlong(image, s.size, m);
            double worst = 0;
            for (int k = 0; k < 6; ++k) {
                const int x = random() % (2 * s.size), y = random() % s.size;
                const Vec3d truth = sampled_latlong_texel(image, x, y, s.size, m, s.width > 8 * s.size ? 700 : 300);
                const float* p = out.at(x, y);
                worst = std::max(worst, relative(Vec3d(p[0], p[1], p[2]), truth));
            }
            INFO(s.width, "x", s.height, " to ", s.size);
            CHECK(worst < 1e-4);
        }
}

TEST_CASE("area_resample: a constant environment stays constant") {
    for (const Shape s : {Shape{1, 1, 4}, {3, 2, 5}, {5, 3, 1}, {64, 32, 33}, {256, 128, 16}})
        for (const Mat3& m : {k_identity, rotation_y(1.1), k_z_up, k_mirror, tilted()}) {
            ImageF image(s.width, s.height, 3);
            fill_constant(image.pixels());
            double worst = 0;
            for (const ImageF& out : {resample_to_cube(image, s.size, m), resample_to_latlong(image, s.size, m)})
                worst = std::max(worst, worst_against_constant(out.pixels()));
            INFO(s.width, "x", s.height, " to ", s.size);
            CHECK(worst < 1e-6);
        }
}

TEST_CASE("area_resample: the light of a single texel is kept, wherever it is") {
    for (const Shape s : {Shape{1, 1, 1}, {3, 2, 4}, {5, 3, 2}, {64, 32, 16}, {64, 32, 5}, {31, 17, 12}, {32, 16, 40}})
        for (const Mat3& m : {k_identity, rotation_y(0.8), k_z_up, k_mirror, tilted()})
            for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 0},
                                                                       {s.width - 1, s.height - 1},
                                                                       {0, s.height / 2},
                                                                       {s.width - 1, s.height / 3},
                                                                       {s.width / 4, 0},
                                                                       {s.width / 8, s.height / 4}}) {
                ImageF image(s.width, s.height, 3);
                image.at(x, y)[1] = 1e5f;
                const Vec3d truth = total_light(image);
                INFO(s.width, "x", s.height, " to ", s.size, ", sun at ", x, ",", y);
                CHECK(relative(cube_light(resample_to_cube(image, s.size, m)), truth) < 1e-5);
                CHECK(relative(latlong_light(resample_to_latlong(image, s.size, m)), truth) < 1e-5);
            }
}

TEST_CASE("area_resample: the same bytes on any number of threads and in any chunks of rows") {
    for (const auto& [s, m] : std::vector<std::pair<Shape, Mat3>>{{{64, 32, 13}, k_identity},
                                                                  {{64, 32, 13}, tilted()},
                                                                  {{512, 256, 64}, k_identity},
                                                                  {{512, 256, 65}, rotation_y(0.3)},
                                                                  {{514, 257, 48}, k_z_up}}) {
        const ImageF image = random_image(s.width, s.height);
        const ImageF cube = resample_to_cube(image, s.size, m);
        const bool plain = m == tilted() || m == k_z_up;  // resampling to a lat-long image is slow
        const int latlong_height = plain ? 3 : s.size;
        const ImageF latlong = resample_to_latlong(image, latlong_height, m);
        for (const auto& [threads, chunk] : std::vector<std::pair<int, int>>{{2, 1}, {3, 7}, {8, s.height}}) {
            CHECK(std::ranges::equal(resample_to_cube(image, s.size, m, threads, chunk).pixels(), cube.pixels()));
            CHECK(std::ranges::equal(resample_to_latlong(image, latlong_height, m, threads, chunk).pixels(),
                                     latlong.pixels()));
        }
    }
}

namespace {

Cubemap random_cube(int size) {
    Cubemap cube(size);
    const ImageF image = random_image(size, 6 * size, 3);
    std::ranges::copy(image.pixels(), cube.pixels().begin());
    return cube;
}

/// ∫ g dω over the sphere by Gauss-Legendre (2 x 2) on a fine grid that contains the lines of texel centres.
Vec3d total_light(const Cubemap& source) {
    const area::CubeIntegrator integrator(source);
    const int cells = 2 * source.size() * std::max(1, 64 / source.size());
    Vec3d sum;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x)
                for (double v : {0.2113248654051871, 0.7886751345948129})
                    for (double u : {0.2113248654051871, 0.7886751345948129}) {
                        const Vec3d d = cube_direction(f, {(x + u) / cells, (y + v) / cells});
                        sum += integrator.at(d) * std::pow(dot(d, d), -1.5);
                    }
    return sum * (1.0 / (double(cells) * cells));
}

}  // namespace

TEST_CASE("area_resample_cube: the reconstruction is continuous across edges and corners") {
    const Cubemap cube = random_cube(5);
    const area::CubeIntegrator g(cube);
    double step = 0;
    for (int f = 0; f < 6; ++f)
        for (double u = 0; u <= 1; u += 0.01)
            for (const UV edge : {UV{u, 0}, UV{u, 1}, UV{0, u}, UV{1, u}}) {
                const auto nudge = [&](double e) { return UV{0.5 + (edge.u - 0.5) * e, 0.5 + (edge.v - 0.5) * e}; };
                step = std::max(
                    step, length(g.at(cube_direction(f, nudge(1 - 1e-9))) - g.at(cube_direction(f, nudge(1 + 1e-9)))));
            }
    // A corner: the mean of the three texels that meet there.
    const float *a = cube.face(0).at(0, 0), *b = cube.face(2).at(4, 4), *c = cube.face(4).at(4, 0);
    CHECK(std::abs(g.at({1, 1, 1}).x - (a[0] + b[0] + c[0]) / 3.0) < 1e-5);
    CHECK(step < 1e-4);  // 100 between neighbours, 5 texels, 1e-9 apart: 1e-6, and the corners' float mean
}

TEST_CASE("area_resample_cube: the same size and axes returns the texels, moved") {
    const Cubemap cube = random_cube(6);
    CHECK(std::ranges::equal(area_resample_cube(cube, 6, k_identity, 1).pixels(), cube.pixels()));
    const Cubemap turned = area_resample_cube(cube, 6, rotation_y(k_pi / 2), 1);
    // The world's +X shows what the source has at +Z.
    CHECK(std::ranges::equal(std::span(turned.face(0).data, 108), std::span(cube.face(4).data, 108)));
}

TEST_CASE("area_resample_cube: texels are averages, the mean is kept, a constant stays constant") {
    std::mt19937 random(5);
    for (const auto& [from, to] :
         std::vector<std::pair<int, int>>{{1, 1}, {1, 4}, {2, 3}, {8, 8}, {8, 3}, {16, 4}, {5, 12}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), k_mirror, tilted()}) {
            const Cubemap cube = random_cube(from);
            const area::CubeIntegrator g(cube);
            const Cubemap out = area_resample_cube(cube, to, m, 1);
            const ImageF latlong = area_resample_cube_to_latlong(cube, to, m, 1);
            INFO(from, " to ", to);
            if (!(from == to && m == k_identity) && !(from == to && m == k_mirror)) {
                CHECK(relative(cube_light(out.strip()), total_light(cube)) < 1e-5);
                double worst = 0;
                for (int k = 0; k < 4; ++k) {
                    const int x = random() % to, y = random() % (6 * to), steps = 300;
                    Vec3d truth;
                    double weight = 0;
                    for (int j = 0; j < steps; ++j)
                        for (int i = 0; i < steps; ++i) {
                            const Vec3d d = cube_direction(
                                y / to, {(x + (i + 0.5) / steps) / to, (y % to + (j + 0.5) / steps) / to});
                            const double w = std::pow(dot(d, d), -1.5);
                            truth += g.at(m * d) * w;
                            weight += w;
                        }
                    const float* p = out.strip().at(x, y);
                    worst = std::max(worst, relative(Vec3d(p[0], p[1], p[2]), truth / weight));
                }
                CHECK(worst < 2e-4);  // the error of the samples
            }
            CHECK(relative(latlong_light(latlong), total_light(cube)) < 1e-5);
            Cubemap grey(from);
            fill_constant(grey.pixels());
            CHECK(worst_against_constant(area_resample_cube(grey, to, m, 1).pixels()) < 1e-6);
            CHECK(worst_against_constant(area_resample_cube_to_latlong(grey, to, m, 1).pixels()) < 1e-6);
        }
}

TEST_CASE("area_resample: the fast version is the plain one") {
    for (const Shape s : {Shape{64, 32, 16},
                          {64, 32, 5},
                          {66, 32, 8},
                          {65, 33, 9},
                          {67, 40, 7},
                          {128, 64, 64},
                          {256, 40, 33},
                          {64, 200, 12},
                          {192, 96, 2},
                          {64, 32, 3}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), rotation_y(k_pi / 2), rotation_y(-2.1), k_z_up, k_mirror}) {
            const ImageF image = random_image(s.width, s.height);
            const ImageF fast = resample_to_cube(image, s.size, m);
            auto plain = area::plain_to_cube(s.width, s.height, s.size, m, 2);
            plain->add_rows(image);
            const ImageF truth = plain->finish();
            double worst = 0;
            int at = 0;
            for (int k = 0; k < int(truth.pixels().size()); ++k) {
                const double e = std::abs(fast.pixels()[k] - truth.pixels()[k]) / (truth.pixels()[k] + 0.1);
                if (e > worst) worst = e, at = k / 3;
            }
            INFO(s.width, "x", s.height, " to ", s.size, ": face ", at / s.size / s.size, " y ", at / s.size % s.size,
                 " x ", at % s.size);
            CHECK(worst < 1e-6);
        }
}

TEST_CASE("area_resample: to a lat-long image, the separable version is the plain one") {
    const Mat3 upside_down{{Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}};
    for (const Shape s : {Shape{5, 3, 4}, {64, 32, 7}, {64, 32, 40}, {9, 40, 3}, {30, 1, 5}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), rotation_y(-2.1), k_mirror, upside_down}) {
            const ImageF image = random_image(s.width, s.height);
            const ImageF fast = resample_to_latlong(image, s.size, m);
            auto plain = area::plain_to_latlong(s.width, s.height, s.size, m, 2);
            plain->add_rows(image);
            const ImageF truth = plain->finish();
            double worst = 0;
            for (int k = 0; k < int(truth.pixels().size()); ++k)
                worst = std::max(worst, std::abs(fast.pixels()[k] - truth.pixels()[k]) / (truth.pixels()[k] + 0.1));
            INFO(s.width, "x", s.height, " to ", s.size);
            CHECK(worst < 1e-6);
        }
}

TEST_CASE("area_resample_cube_to_latlong: the fast version is the plain one") {
    struct Sizes {
        int cube, height;
    };
    // With and without columns that quarter turns and mirrors repeat, a middle row, a texel centre at the poles; larger
    // and smaller.
    for (const Sizes s : {Sizes{1, 1},
                          {1, 4},
                          {2, 3},
                          {3, 2},
                          {5, 12},
                          {8, 3},
                          {15, 31},
                          {16, 4},
                          {33, 65},
                          {64, 5},
                          {64, 60},
                          {32, 64},
                          {48, 26}})
        for (const Mat3& m : {k_identity, rotation_y(0.3), k_mirror, k_z_up, k_z_up * rotation_y(2.9)}) {
            const Cubemap cube = random_cube(s.cube);
            const ImageF fast = area_resample_cube_to_latlong(cube, s.height, m, 2);
            const ImageF truth = area::plain_cube_to_latlong(cube, s.height, m, 2);
            double worst = 0;
            for (std::size_t k = 0; k < truth.pixels().size(); ++k)
                worst =
                    std::max(worst, std::abs(double(fast.pixels()[k]) - truth.pixels()[k]) / (truth.pixels()[k] + 0.1));
            INFO(s.cube, " to ", s.height);
            CHECK(worst <
                  1e-6);  // rounding to float is 1e-7; the plain version's quadrature, at a contrast of 100, 5e-7
            CHECK(std::ranges::equal(area_resample_cube_to_latlong(cube, s.height, m, 1).pixels(), fast.pixels()));
        }
}

TEST_CASE("area_resample_cube: the fast version for exchanged axes is the plain one") {
    struct Sizes {
        int from, to;
    };
    for (const Sizes s : {Sizes{1, 2}, {1, 5}, {2, 1}, {3, 2}, {8, 3}, {5, 12}, {15, 31}, {64, 40}, {32, 64}, {96, 7}})
        for (const Mat3& m : {k_identity, k_mirror, k_z_up}) {
            const Cubemap cube = random_cube(s.from), fast = area_resample_cube(cube, s.to, m, 2),
                          truth = area::plain_cube_to_cube(cube, s.to, m, 2);
            double worst = 0;
            for (std::size_t k = 0; k < truth.pixels().size(); ++k)
                worst =
                    std::max(worst, std::abs(double(fast.pixels()[k]) - truth.pixels()[k]) / (truth.pixels()[k] + 0.1));
            INFO(s.from, " to ", s.to);
            CHECK(worst < 2e-7);  // the rounding of floats
            CHECK(std::ranges::equal(area_resample_cube(cube, s.to, m, 1).pixels(), fast.pixels()));
        }
}

TEST_CASE("area_resample_cube_to_latlong: every direction shows the light of its own") {
    // Directions as colours: a wrong turn or mirror of any part would be a difference of 1.
    const int size = 64;
    Cubemap cube(size);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size}));
                float* p = cube.strip().at(x, f * size + y);
                p[0] = float(d.x), p[1] = float(d.y), p[2] = float(d.z);
            }
    for (const Mat3& m : {k_identity, k_mirror, k_z_up, rotation_y(1)}) {
        const ImageF latlong = area_resample_cube_to_latlong(cube, 2 * size, m, 1);
        double worst = 0;
        for (int y = 0; y < latlong.height(); ++y)
            for (int x = 0; x < latlong.width(); ++x) {
                const float* p = latlong.at(x, y);
                const Vec3d d = m * latlong_direction({(x + 0.5) / latlong.width(), (y + 0.5) / latlong.height()});
                worst = std::max(worst, length(Vec3d(p[0], p[1], p[2]) - d));
            }
        CHECK(worst < 0.01);  // where three faces meet, the reconstruction is a mean of three texels
    }
}

TEST_CASE("area_resample: large sources keep a constant and the light of one texel, near the poles too") {
    // Near a pole an output texel averages thousands of source texels: the rounding of float sums must not accumulate.
    for (const auto& [s, angle] : std::vector<std::pair<Shape, double>>{
             {{4096, 2048, 256}, 0}, {{4095, 2047, 255}, 0.5}, {{2048, 1024, 8}, 0}}) {
        const Mat3 m = rotation_y(angle);
        INFO(s.width, "x", s.height, " to ", s.size);
        std::vector<float> row(std::size_t(s.width) * 3);
        fill_constant(row);
        auto resampler = area_resample_to_cube(s.width, s.height, s.size, m, 2);
        for (int y = 0; y < s.height; ++y) resampler->add_rows({row.data(), s.width, 1, 3});
        const ImageF constant = resampler->finish();
        CHECK(worst_against_constant(constant.pixels()) < 1e-6);
        ImageF image(s.width, s.height, 3);
        // One channel each: the pole row, the seam, elsewhere.
        image.at(s.width / 3, 0)[0] = image.at(s.width - 1, s.height / 3)[1] = image.at(s.width / 7, s.height - 40)[2] =
            1e5f;
        const Vec3d light = cube_light(resample_to_cube(image, s.size, m, 2)), truth = total_light(image);
        CHECK(std::abs(light.x / truth.x - 1) < 1e-5);
        CHECK(std::abs(light.y / truth.y - 1) < 1e-5);
        CHECK(std::abs(light.z / truth.z - 1) < 1e-5);
    }
}

TEST_CASE("area_resample: every instruction set gives the same to 1e-6") {
    const ImageF image = random_image(512, 256);
    const ImageF best = resample_to_cube(image, 65, rotation_y(0.2));
    const auto check = [&](const char* set) {
        const ImageF other = resample_to_cube(image, 65, rotation_y(0.2));
        double worst = 0;
        for (int k = 0; k < int(best.pixels().size()); ++k)
            worst = std::max(worst, double(std::abs(other.pixels()[k] - best.pixels()[k])) / best.pixels()[k]);
        INFO(set);
        CHECK(worst < 1e-6);
    };
    for (const char* set : {"AVX2", "SSE4"}) {
        simd::limit_instruction_set(set);
        check(set);
    }
    // The plain code, which limit_instruction_set calls EMU128. Not every compiler builds it.
    hwy::SetSupportedTargetsForTest(HWY_TARGETS & (HWY_SCALAR | HWY_EMU128));
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check("plain");
    simd::limit_instruction_set("");
}
