#include "domelight/probe/tetrahedra.h"

#include "domelight/base/random.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace domelight;

namespace {

float number(int i, int k) {
    return float(derive_key(std::uint64_t(i), std::uint64_t(k)) >> 40) * 0x1p-24f;
}
Vec3f random_point(int i) {
    return {number(i, 0), number(i, 1), number(i, 2)};
}
std::vector<Vec3f> random_points(int count, const Vec3f& size) {
    std::vector<Vec3f> points;
    for (int i = 0; i < count; ++i) points.push_back(product(random_point(i), size));
    return points;
}
std::vector<Vec3f> grid_points(int nx, int ny, int nz) {
    std::vector<Vec3f> points;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) points.push_back({float(x), float(y), float(z)});
    return points;
}

double volume(const std::array<int, 4>& cell, const std::vector<Vec3f>& points) {
    const Vec3d a(points[cell[0]]), b(points[cell[1]]), c(points[cell[2]]), d(points[cell[3]]);
    return dot(cross(b - a, c - a), d - a) / 6;
}

Vec3d centre_of_sphere(const std::array<int, 4>& cell, const std::vector<Vec3f>& points) {
    const Vec3d a(points[cell[0]]), u = Vec3d(points[cell[1]]) - a, v = Vec3d(points[cell[2]]) - a,
                                    w = Vec3d(points[cell[3]]) - a;
    return a +
           (cross(v, w) * dot(u, u) + cross(w, u) * dot(v, v) + cross(u, v) * dot(w, w)) / (2 * dot(cross(u, v), w));
}

Vec3d interpolated_place(const Tetrahedra::Weights& w, const std::vector<Vec3f>& points) {
    Vec3d sum;
    for (std::size_t i = 0; i < 4; ++i) sum += Vec3d(points[w.point[i]]) * double(w.weight[i]);
    return sum;
}

}  // namespace

TEST_SUITE("probe") {
    TEST_CASE("tetrahedra: no point lies deep inside of the sphere of a tetrahedron") {
        const std::vector<Vec3f> points = random_points(200, {1, 1, 1});
        const Tetrahedra tetrahedra(points);
        for (const auto& cell : tetrahedra.cells()) {
            const Vec3d centre = centre_of_sphere(cell, points);
            const double radius = length(Vec3d(points[cell[0]]) - centre);
            for (const Vec3f& p : points) REQUIRE(length(Vec3d(p) - centre) > radius - 2e-3);
        }
    }

    TEST_CASE("tetrahedra: without copies of the outermost points, they fill the hull of points anywhere") {
        std::vector<Vec3f> points = random_points(40, {1, 1, 1});
        for (const Vec3f& corner : grid_points(2, 2, 2)) points.push_back(corner);  // the hull is the unit cube
        const Tetrahedra tetrahedra(points, Tetrahedra::Outside::nothing);
        double sum = 0;
        for (const auto& cell : tetrahedra.cells()) sum += volume(cell, points);
        CHECK(sum == doctest::Approx(1).epsilon(1e-3));
    }

    TEST_CASE("tetrahedra: those of a grid fill its box") {
        const std::vector<Vec3f> points = grid_points(6, 5, 4);
        const Tetrahedra tetrahedra(points);
        double sum = 0;
        for (const auto& cell : tetrahedra.cells()) {
            CHECK(volume(cell, points) > -1e-4);
            sum += volume(cell, points);
        }
        CHECK(sum == doctest::Approx(5 * 4 * 3).epsilon(1e-4));
    }

    TEST_CASE("tetrahedra: weights reproduce the place inside of the hull, and its nearest point outside") {
        const std::vector<Vec3f> points = grid_points(6, 5, 4);
        const Tetrahedra tetrahedra(points);
        for (int i = 0; i < 5000; ++i) {
            const Vec3f place = product(random_point(i), {9, 8, 7}) - Vec3f{2, 2, 2};
            const Tetrahedra::Weights w = tetrahedra.at(place);
            const Vec3d nearest{std::clamp(double(place.x), 0.0, 5.0), std::clamp(double(place.y), 0.0, 4.0),
                                std::clamp(double(place.z), 0.0, 3.0)};
            REQUIRE(length(interpolated_place(w, points) - nearest) < 2e-3);
            float sum = 0;
            for (const float weight : w.weight) {
                REQUIRE(weight >= 0);
                sum += weight;
            }
            REQUIRE(sum == doctest::Approx(1).epsilon(1e-5));
        }
    }

    TEST_CASE("tetrahedra: the interpolation is continuous along lines") {
        // Squares of a grid could have flat tetrahedra across which the interpolation jumps.
        std::vector<Vec3f> grid = grid_points(5, 5, 5);
        for (Vec3f& p : grid) p *= 0.25f;
        for (const std::vector<Vec3f>& points : {random_points(120, {1, 1, 1}), grid}) {
            const Tetrahedra tetrahedra(points);
            double largest = 0;
            for (int line = 0; line < 40; ++line) {
                const Vec3f a = random_point(1000 + line) * 2.f - Vec3f{0.5f, 0.5f, 0.5f},
                            b = random_point(2000 + line) * 2.f - Vec3f{0.5f, 0.5f, 0.5f};
                double last = 0;
                for (int k = 0; k <= 4000; ++k) {
                    const Tetrahedra::Weights w = tetrahedra.at(a + (b - a) * (float(k) / 4000));
                    double value = 0;  // of a function that is random at each point
                    for (std::size_t i = 0; i < 4; ++i) value += double(w.weight[i]) * double(number(w.point[i], 7));
                    if (k) largest = std::max(largest, std::abs(value - last));
                    last = value;
                }
            }
            // A step of 5e-4 or less through the thinnest tetrahedra; a jump would be of the order of 0.5.
            CHECK(largest < 0.05);
        }
    }

    TEST_CASE("tetrahedra: points on a plane, on a line, and alone") {
        const auto exact_for = [](const std::vector<Vec3f>& points, const Vec3f& place, const Vec3d& expected) {
            CHECK(length(interpolated_place(Tetrahedra(points).at(place), points) - expected) < 1e-3);
        };
        const std::vector<Vec3f> plane = grid_points(5, 1, 4), line = grid_points(5, 1, 1), one{{3, 2, 1}};
        exact_for(plane, {2.3f, 0, 1.7f}, {2.3, 0, 1.7});
        exact_for(plane, {2.3f, 4, 1.7f}, {2.3, 0, 1.7});
        exact_for(plane, {7, -2, 1.7f}, {4, 0, 1.7});
        exact_for(line, {2.3f, 5, -3}, {2.3, 0, 0});
        exact_for(line, {-2, 5, -3}, {0, 0, 0});
        exact_for(one, {0, 0, 0}, {3, 2, 1});
        // A plane whose points are moved a little, as probes are that keep away from furniture.
        std::vector<Vec3f> moved = plane;
        for (int i = 0; i < int(moved.size()); ++i) moved[std::size_t(i)].y += 0.2f * number(i, 3);
        for (int i = 0; i < 500; ++i) {
            const Vec3f place = product(random_point(i), {4, 6, 3}) - Vec3f{0, 3, 0};
            const Vec3d found = interpolated_place(Tetrahedra(moved).at(place), moved);
            REQUIRE(std::hypot(found.x - double(place.x), found.z - double(place.z)) < 0.1);
        }
    }

    TEST_CASE("tetrahedra: a point given twice has its weight once") {
        std::vector<Vec3f> points = grid_points(2, 2, 2);
        points.push_back(points[3]);
        const Tetrahedra tetrahedra(points);
        for (const auto& cell : tetrahedra.cells())
            for (const int p : cell) CHECK(p != 8);
    }

    TEST_CASE("tetrahedra: two thousand points") {
        const std::vector<Vec3f> points = random_points(2000, {20, 3, 10});
        const Tetrahedra tetrahedra(points);
        for (int i = 0; i < 2000; ++i) {
            const Vec3f place = product(random_point(9000 + i), {16, 0.6f, 6}) + Vec3f{2, 1.2f, 2};
            REQUIRE(length(interpolated_place(tetrahedra.at(place), points) - Vec3d(place)) < 1e-3);
        }
    }
}
