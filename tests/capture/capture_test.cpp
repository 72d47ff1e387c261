#include "domelight/capture/capture.h"

#include "domelight/capture/probe_baker.h"
#include "domelight/projection/projection.h"

#include "render/shapes.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace domelight {
namespace {

/// A closed sphere of radius 1 about the origin, seen from inside, that emits `radiance`.
RayScene glowing_sphere(const Vec3f& radiance) {
    Scene scene;
    Material m = test::lambert_material(0);
    m.double_sided = true;
    m.emission = radiance;
    test::add(scene, test::sphere_mesh(48), m);
    return *RayScene::build(std::move(scene));
}

EnvironmentSampler sky_of(const ImageF& image) {
    return *EnvironmentSampler::build(image.view(), reference_sampler_options());
}

ImageF gradient() {
    ImageF image(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = 1 + 0.5f * std::sin((float(y) + 0.5f) * float(k_pi) / 32) *
                                            std::cos(float(x) * float(k_pi) / 32 + float(c));
    return image;
}

std::map<int, CapturedCube> captured(const RayScene& scene, const EnvironmentSampler& sky,
                                     const std::vector<Vec3f>& positions, const std::vector<int>& numbers,
                                     const CaptureOptions& options) {
    std::map<int, CapturedCube> cubes;
    std::mutex mutex;
    const auto ok = capture(scene, sky, positions, numbers, options, [&](int i, CapturedCube cube) -> Result<void> {
        const std::lock_guard lock(mutex);
        cubes[i] = std::move(cube);
        return {};
    });
    REQUIRE(ok);
    return cubes;
}

bool equal(const Cubemap& a, const Cubemap& b) {
    return std::ranges::equal(a.pixels(), b.pixels());
}

TEST_CASE("capture: inside a glowing sphere every texel has its radiance and its distance") {
    const RayScene scene = glowing_sphere({1, 2, 3});
    const ImageF black(8, 4, 3);
    CaptureOptions options;
    options.size = 8, options.samples = 4;
    const auto cubes = captured(scene, sky_of(black), {{0, 0, 0}, {0.5f, 0, 0}}, {0, 1}, options);
    REQUIRE(cubes.size() == 2);
    for (const auto& [i, cube] : cubes)
        for (int f = 0; f < 6; ++f)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    CHECK(cube.radiance.face(f).at(x, y)[2] == 3);
                    CHECK(*cube.coverage.face(f).at(x, y) == 1);
                    const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / 8, (y + 0.5) / 8}));
                    // |c + t d| = 1 for the centre c of the probe; a texel's mean differs by the angle it covers.
                    const double along = i * 0.5 * d.x, t = -along + std::sqrt(along * along + 1 - i * 0.25);
                    CHECK(*cube.depth.face(f).at(x, y) == doctest::Approx(t).epsilon(0.08));
                }
}

TEST_CASE("capture: in open space the texels are those of the environment") {
    Scene far;
    test::add(far, test::floor_mesh(1e-3f, -1000), test::lambert_material(0.5f));
    const RayScene scene = *RayScene::build(std::move(far));
    const ImageF image = gradient();
    const EnvironmentSampler sky = sky_of(image);
    CaptureOptions options;
    options.size = 16, options.samples = 64;
    const auto cubes = captured(scene, sky, {{3, 4, 5}}, {7}, options);
    const CapturedCube& cube = cubes.at(0);
    double worst = 0;
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                const Vec3f centre = sky.radiance(Vec3f(cube_direction(f, {(x + 0.5) / 16, (y + 0.5) / 16})));
                worst = std::max(worst, double(std::abs(cube.radiance.face(f).at(x, y)[0] - centre.x)));
                CHECK(*cube.coverage.face(f).at(x, y) == 0);
            }
    CHECK(worst < 0.02);  // the mean over a texel of 5.6 degrees, from 64 samples
}

TEST_CASE("capture: a probe's bits depend on its number alone, not on threads or on the other probes") {
    Scene room;
    test::add(room, test::floor_mesh(2, -1), test::lambert_material(0.7f));
    test::add(room, test::sphere_mesh(8), test::metal_material(0.3f), {.translation = {0, 0, -3}});
    const RayScene scene = *RayScene::build(std::move(room));
    const ImageF image = gradient();
    const EnvironmentSampler sky = sky_of(image);
    CaptureOptions one, four;
    one.size = four.size = 16, one.samples = four.samples = 4, one.noise = four.noise = 0.02;
    one.most_samples = four.most_samples = 32;
    one.threads = 1, four.threads = 4;
    std::vector<Vec3f> positions;
    std::vector<int> numbers;
    for (int i = 0; i < 11; ++i) positions.push_back({0.2f * float(i), 0, 0}), numbers.push_back(i);
    const auto a = captured(scene, sky, positions, numbers, one), b = captured(scene, sky, positions, numbers, four),
               c = captured(scene, sky, {positions[9]}, {9}, four);
    for (int i = 0; i < 11; ++i) {
        CHECK(equal(a.at(i).radiance, b.at(i).radiance));
        CHECK(equal(a.at(i).depth, b.at(i).depth));
    }
    CHECK(equal(a.at(9).radiance, c.at(0).radiance));
    // Each number has random numbers of its own, also at the same position.
    CHECK_FALSE(equal(captured(scene, sky, {positions[9]}, {8}, four).at(0).radiance, c.at(0).radiance));
}

TEST_CASE("capture: more samples are taken until the noise is low enough") {
    Scene room;
    test::add(room, test::floor_mesh(2, -1), test::lambert_material(0.7f));
    const RayScene scene = *RayScene::build(std::move(room));
    ImageF sun(32, 16, 3, 0.1f);
    for (int c = 0; c < 3; ++c) sun.at(5, 3)[c] = 500;
    const EnvironmentSampler sky = sky_of(sun);
    CaptureOptions options;
    options.size = 8, options.samples = 2;
    const auto plain = captured(scene, sky, {{0, 0, 0}}, {0}, options);
    options.noise = 0.01, options.most_samples = 4096;
    const auto fine = captured(scene, sky, {{0, 0, 0}}, {0}, options);
    CHECK(fine.at(0).rays > 2 * plain.at(0).rays);
}

TEST_CASE("capture: errors name the field, cancelling stops it, and an error of the receiver comes back") {
    const RayScene scene = glowing_sphere({1, 1, 1});
    const ImageF black(8, 4, 3);
    const EnvironmentSampler sky = sky_of(black);
    const std::vector<Vec3f> positions(20);
    std::vector<int> numbers(20);
    CaptureOptions options;
    options.size = 8, options.samples = 1;
    const auto accept = [](int, CapturedCube) -> Result<void> { return {}; };
    CaptureOptions wrong = options;
    wrong.size = 4;
    CHECK(capture(scene, sky, positions, numbers, wrong, accept).error().where == "`size`");
    wrong = options, wrong.samples = 0;
    CHECK(capture(scene, sky, positions, numbers, wrong, accept).error().where == "`samples`");
    wrong = options, wrong.noise = NAN;
    CHECK(capture(scene, sky, positions, numbers, wrong, accept).error().where == "`noise`");
    wrong = options, wrong.progress = [](std::string_view, double done) { return done < 0.3; };
    CHECK(capture(scene, sky, positions, numbers, wrong, accept).error().what == "cancelled");
    const auto refuse = [](int i, CapturedCube) -> Result<void> {
        return i == 3 ? Result<void>(Error{"full", "", ""}) : Result<void>();
    };
    CHECK(capture(scene, sky, positions, numbers, options, refuse).error().what == "full");
}

CapturedCube uniform_capture(int size, float radiance, float depth, float coverage) {
    CapturedCube cube{Cubemap(size), Cubemap(size, 1), Cubemap(size, 1)};
    std::ranges::fill(cube.radiance.pixels(), radiance);
    std::ranges::fill(cube.depth.pixels(), depth);
    std::ranges::fill(cube.coverage.pixels(), coverage);
    return cube;
}

TEST_CASE("ProbeBaker: uniform light and distance stay what they are") {
    ProbeBakerOptions options;
    options.size = 32, options.distance_size = 8, options.farthest = 20;
    const auto filter = ProbeBaker::make(options);
    REQUIRE(filter);
    CHECK(filter->options().levels == 4);  // 32, 16, 8, 4
    const auto maps = (*filter)(uniform_capture(32, 2, 3, 0.75f));
    REQUIRE(maps);
    for (const Cubemap& level : maps->specular)
        for (const float v : level.pixels()) CHECK(v == doctest::Approx(2).epsilon(1e-4));
    for (const float v : maps->irradiance_over_pi.pixels()) CHECK(v == doctest::Approx(2).epsilon(1e-4));
    CHECK(maps->harmonics[0].x == doctest::Approx(2 * std::sqrt(4 * k_pi)).epsilon(1e-5));
    // A quarter of each texel shows the sky, which counts as 20 metres.
    for (int i = 0; i < 6 * 64; ++i) {
        CHECK(maps->distance.pixels()[std::size_t(2 * i)] == doctest::Approx(0.75 * 3 + 0.25 * 20).epsilon(1e-5));
        CHECK(maps->distance.pixels()[std::size_t(2 * i + 1)] == doctest::Approx(0.75 * 9 + 0.25 * 400).epsilon(1e-5));
    }
}

TEST_CASE("ProbeBaker: distances are means over a texel's area") {
    ProbeBakerOptions options;
    options.size = 16, options.distance_size = 4, options.farthest = 100;
    CapturedCube cube = uniform_capture(16, 1, 2, 1);
    *cube.depth.face(3).at(5, 9) = 10;  // one of the 16 texels of texel (1, 2)
    const auto maps = (*ProbeBaker::make(options))(cube);
    REQUIRE(maps);
    CHECK(maps->distance.face(3).at(1, 2)[0] == doctest::Approx((15 * 2 + 10) / 16.0));
    CHECK(maps->distance.face(3).at(1, 2)[1] == doctest::Approx((15 * 4 + 100) / 16.0));
    CHECK(maps->distance.face(3).at(1, 1)[0] == 2);
    CHECK(maps->distance.face(2).at(1, 2)[0] == 2);
}

TEST_CASE("ProbeBaker: surfaces farther away than `farthest` count as that far") {
    ProbeBakerOptions options;
    options.size = 16, options.distance_size = 4, options.farthest = 2;
    const auto maps = (*ProbeBaker::make(options))(uniform_capture(16, 1, 1000, 1));
    REQUIRE(maps);
    CHECK(maps->distance.pixels()[0] == doctest::Approx(2));
    CHECK(maps->distance.pixels()[1] == doctest::Approx(4));
}

TEST_CASE("size_for_budget: the largest size that fits, by the bytes that files have") {
    // Faces of 64, 32, 16, 8, 4 and of 16 texels of 4 bytes, and of 32 texels of 8 bytes.
    const std::uint64_t maps = 6 * (4 * (4096 + 1024 + 256 + 64 + 16 + 256) + 8 * 1024);
    CHECK(probe_bytes({.size = 64}, Encoding::rgb9e5) == maps + 1000);
    const auto size = [](std::uint64_t bytes, int probes) {
        const auto found = size_for_budget({}, Encoding::rgb9e5, bytes, probes);
        return found ? *found : 0;
    };
    CHECK(size(10 * (maps + 1000), 10) == 64);
    CHECK(size(10 * (maps + 1000) - 1, 10) == 32);
    CHECK(size(1u << 30, 1) == 512);
    CHECK(size(30000, 10) == 0);
    CHECK(size_for_budget({}, Encoding::rgb9e5, 30000, 10).error().where == "`budget`");
    // Distances of 32 texels need faces of at least as many.
    CHECK(*size_for_budget({.distance_size = 32}, Encoding::rgba32f, 210'000, 1) == 32);
}

TEST_CASE("ProbeBaker: errors name the field") {
    const auto where = [](ProbeBakerOptions options) { return ProbeBaker::make(options).error().where; };
    CHECK(where({.size = 4}) == "`size`");
    CHECK(where({.size = 32, .levels = 7}) == "`levels`");
    CHECK(where({.levels = 1}) == "`levels`");
    CHECK(where({.irradiance_size = 0}) == "`irradiance_size`");
    CHECK(where({.distance_size = 24}) == "`distance_size`");
    CHECK(where({.farthest = 0}) == "`farthest`");
}

}  // namespace
}  // namespace domelight
