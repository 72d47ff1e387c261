#include "domelight/probe/probe_set.h"

#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/projection/projection.h"

#include "probe/cube_of.h"
#include "projection/bilinear.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace domelight {
namespace {

using test::cube_of;

/// In the middle of a cube with walls 2 (probe + 1) metres apart.
double wall_distance(int probe, const Vec3d& direction) {
    return (probe + 1) / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
}

/// Maps that differ from probe to probe and from level to level.
ProbeMaps labelled_maps(int probe) {
    ProbeMaps maps;
    for (const int size : {16, 8, 4}) {
        const double scale = (probe + 1) * size;
        maps.specular.push_back(cube_of(size, 3, [&](const Vec3d& d, float* p) {
            p[0] = float(scale * (1.5 + d.x)), p[1] = float(scale * (1.5 + d.y)), p[2] = float(scale * (1.5 + d.z));
        }));
    }
    maps.irradiance_over_pi =
        cube_of(8, 3, [&](const Vec3d& d, float* p) { p[0] = p[1] = float(probe + 2 + d.y), p[2] = 1; });
    maps.harmonics[0] = Vec3d{1, 2, 3} * (std::sqrt(4 * k_pi) * (probe + 1));
    maps.harmonics[1] = Vec3d{1, 0, 0};
    maps.distance = cube_of(
        8, 2, [&](const Vec3d& d, float* p) { p[0] = float(wall_distance(probe, d)), p[1] = p[0] * p[0] + 0.25f; });
    return maps;
}

Result<ProbeSet> labelled_set(int count) {
    std::vector<ProbeMaps> maps;
    std::vector<Probe> probes;
    for (int i = 0; i < count; ++i) {
        maps.push_back(labelled_maps(i));
        probes.push_back({.place = {float(i), 0, 0}, .position = {float(i), 0, 0}});
    }
    return ProbeSet::from_maps(std::move(probes), ProbeGrid{.nx = count}, {0, 0.25f, 1}, maps);
}

std::vector<Vec3f> some_directions() {
    std::vector<Vec3f> directions;
    for (int i = 0; i < 200; ++i) {
        const double y = 1 - (2 * i + 1.0) / 200, s = std::sqrt(1 - y * y), a = 2.399963 * i;
        directions.push_back(Vec3f(Vec3d{s * std::cos(a), y, s * std::sin(a)}));
    }
    return directions;
}

/// By how much the largest component of a direction exceeds the next, as a part of it: 0 at the edges of faces.
double largest_two_apart(const Vec3f& d) {
    float c[3] = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    std::ranges::sort(c);
    return (c[2] - c[1]) / c[2];
}

double difference(const Vec3f& a, const Vec3f& b) {
    return length(Vec3d(a) - Vec3d(b));
}

TEST_CASE("ProbeSet: each probe has the maps that it was given, to the precision of RGB9E5") {
    const auto set = labelled_set(3);
    REQUIRE(set);
    CHECK(set->specular_size() == 16);
    CHECK(set->irradiance_size() == 8);
    CHECK(set->distance_size() == 8);
    for (int probe = 0; probe < 3; ++probe) {
        const ProbeMaps maps = labelled_maps(probe);
        const BorderedCube sharp(maps.specular[0]), rough(maps.specular[1]), irradiance(maps.irradiance_over_pi);
        for (const Vec3f& d : some_directions()) {
            // Half a step of nine bits, for the largest of three channels.
            const double scale = 40.0 * (probe + 1);
            CHECK(difference(set->radiance(probe, d, 0), look_up(sharp, d)) < scale * 1.5 / 512);
            CHECK(difference(set->radiance(probe, d, 0.25f), look_up(rough, d)) < scale / 2 * 1.5 / 512);
            CHECK(difference(set->irradiance_over_pi(probe, d), look_up(irradiance, d)) < (probe + 3) * 1.5 / 512);
            const DistanceMoments moments = set->distance(probe, d);
            // Exact for walls; within the tolerance for the corners between them, which run along the edges of faces.
            CHECK(moments.mean == doctest::Approx(wall_distance(probe, Vec3d(d))).epsilon(0.3 / 8));
            const double off_edge = largest_two_apart(d);
            if (off_edge > 0.25) CHECK(moments.mean == doctest::Approx(wall_distance(probe, Vec3d(d))).epsilon(1e-5));
            const double variance = moments.mean_square - moments.mean * moments.mean;
            CHECK(variance <= 0.2501);
            if (off_edge > 0.25) CHECK(variance > 0.2);
        }
    }
}

TEST_CASE(
    "ProbeSet: between levels the radiance is linear in the logarithm of the roughness, from level 0 in the "
    "roughness") {
    const auto set = labelled_set(1);
    REQUIRE(set);
    const Vec3f d{0, 0, 2};
    const Vec3f sharp = set->radiance(0, d, 0), middle = set->radiance(0, d, 0.25f), rough = set->radiance(0, d, 1);
    CHECK(difference(set->radiance(0, d, 0.125f), (sharp + middle) * 0.5f) < 1e-4);
    CHECK(difference(set->radiance(0, d, 0.5f), (middle + rough) * 0.5f) < 1e-4);
    CHECK(difference(set->radiance(0, d, 2), rough) == 0);
}

TEST_CASE("ProbeSet: the irradiance by harmonics is the cosine convolution of the radiance") {
    const auto set = labelled_set(2);
    REQUIRE(set);
    // Y_00 a_00 = (1, 2, 3) (probe + 1); Y_1,-1 = sqrt(3 / 4 pi) y, and the cosine lobe keeps 2 / 3 of it.
    const Vec3f up = set->irradiance_over_pi_sh(1, {0, 3, 0});
    CHECK(up.x == doctest::Approx(2 + std::sqrt(3 / (4 * k_pi)) * 2 / 3));
    CHECK(up.z == doctest::Approx(6));
    CHECK(set->harmonics(1)[1].x == 1);
}

TEST_CASE("ProbeSet: lookups are continuous across the edges of faces") {
    const auto set = labelled_set(1);
    REQUIRE(set);
    for (const float y : {-0.9f, -0.31f, 0.f, 0.77f})
        for (const float roughness : {0.f, 0.3f}) {
            const Vec3f a = set->radiance(0, {1, y, 1 - 1e-6f}, roughness),
                        b = set->radiance(0, {1 - 1e-6f, y, 1}, roughness);
            CHECK(difference(a, b) < 1e-3 * length(a));
        }
}

TEST_CASE("ProbeSet: without distances nothing is near") {
    std::vector<ProbeMaps> maps{labelled_maps(0)};
    maps[0].distance = {};
    const auto set = ProbeSet::from_maps({Probe{}}, std::nullopt, {0, 0.25f, 1}, maps);
    REQUIRE(set);
    CHECK(set->distance_size() == 0);
    CHECK(std::isinf(set->distance(0, {1, 0, 0}).mean));
}

TEST_CASE("ProbeSet: errors name the field") {
    const auto error = [](std::vector<Probe> probes, std::optional<ProbeGrid> grid, std::vector<float> roughness,
                          std::vector<ProbeMaps> maps) {
        const auto set = ProbeSet::from_maps(std::move(probes), grid, std::move(roughness), maps);
        return set ? std::string() : set.error().format();
    };
    const std::vector<ProbeMaps> two{labelled_maps(0), labelled_maps(1)};
    const std::vector<float> levels{0, 0.25f, 1};
    CHECK(error(std::vector<Probe>(2), std::nullopt, levels, two).empty());
    CHECK(error({}, std::nullopt, levels, {}).starts_with("`probes`"));
    CHECK(error(std::vector<Probe>(3), std::nullopt, levels, two).starts_with("`maps`"));
    CHECK(error(std::vector<Probe>(2), ProbeGrid{.nx = 3}, levels, two).starts_with("`grid`"));
    CHECK(error(std::vector<Probe>(2), ProbeGrid{.spacing = {1, 0, 1}, .nx = 2}, levels, two).starts_with("`grid`"));
    CHECK(error(std::vector<Probe>(2), std::nullopt, {0, 1}, two).starts_with("`maps`"));
    CHECK(error(std::vector<Probe>(2), std::nullopt, {0, 1, 0.5f}, two).starts_with("`roughness`"));
    std::vector<ProbeMaps> other = two;
    other[1].irradiance_over_pi = Cubemap(4);
    CHECK(error(std::vector<Probe>(2), std::nullopt, levels, other).starts_with("`maps`: an irradiance"));
    other = two;
    other[1].distance = {};
    CHECK(error(std::vector<Probe>(2), std::nullopt, levels, other).starts_with("`maps`: distances"));
}

TEST_CASE("cell_at: weights reproduce a linear function, and a point outside counts as the nearest inside") {
    const ProbeGrid grid{.origin = {-1, 2, 0}, .spacing = {0.5f, 2, 1}, .nx = 4, .ny = 1, .nz = 3};
    const auto value = [](const Vec3f& p) { return 3 * p.x - p.y + 2 * p.z; };
    for (const Vec3f& p : {Vec3f{-1, 2, 0}, {-0.3f, 2, 1.9f}, {0.5f, 2, 2}, {0.2f, 5, 1}, {9, 2, -3}}) {
        const GridCell cell = cell_at(grid, p);
        float sum = 0, interpolated = 0;
        for (std::size_t i = 0; i < 8; ++i) {
            CHECK(cell.weight[i] >= 0);
            REQUIRE(cell.place[i] >= 0);
            REQUIRE(cell.place[i] < grid.count());
            sum += cell.weight[i];
            interpolated += cell.weight[i] * value(grid.place(cell.place[i]));
        }
        const Vec3f inside{std::clamp(p.x, -1.f, 0.5f), 2, std::clamp(p.z, 0.f, 2.f)};
        CHECK(sum == doctest::Approx(1));
        CHECK(interpolated == doctest::Approx(value(inside)));
    }
}

}  // namespace
}  // namespace domelight
