#include "domelight/projection/projection.h"

#include "test.h"

#include <vector>

using namespace domelight;

TEST_CASE("latlong: the centre is +X, to its right lies +Z, the top is +Y") {
    const auto near = [](Vec3d a, Vec3d b) { return length(a - b) < 1e-15; };
    CHECK(near(latlong_direction({0.5, 0.5}), {1, 0, 0}));
    CHECK(near(latlong_direction({0.75, 0.5}), {0, 0, 1}));
    CHECK(near(latlong_direction({0.25, 0.5}), {0, 0, -1}));
    CHECK(near(latlong_direction({0.3, 0.0}), {0, 1, 0}));
}

TEST_CASE("cube: direction and point are inverse, faces in OpenGL's order") {
    const Vec3d axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int f = 0; f < 6; ++f) {
        CHECK(cube_point(axes[f]).face == f);
        for (double u : {0.01, 0.3, 0.99})
            for (double v : {0.02, 0.6, 0.98}) {
                const CubePoint p = cube_point(cube_direction(f, {u, v}));
                CHECK(p.face == f);
                CHECK(std::abs(p.uv.u - u) < 1e-15);
                CHECK(std::abs(p.uv.v - v) < 1e-15);
            }
    }
}

TEST_CASE("solid angles: texels of every size sum to 4 pi") {
    for (int size : {1, 2, 3, 64, 1024}) {
        double sum = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) sum += cube_solid_angle(x, y, size);
        CHECK(std::abs(6 * sum - 4 * k_pi) < 1e-9);  // rounding of 6 million terms
    }
    for (int height : {1, 2, 5, 2048}) {
        double sum = 0;
        for (int y = 0; y < height; ++y) sum += 2 * height * latlong_solid_angle(y, 2 * height, height);
        CHECK(std::abs(sum - 4 * k_pi) < 1e-12);
    }
}

namespace {

/// Directions over the sphere, with the axes and points close to them.
std::vector<Vec3d> probes() {
    std::vector<Vec3d> list;
    for (const double e : {0.0, 1e-3, 1e-6, 1e-9})
        for (const Vec3d& axis : {Vec3d{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
            list.push_back(normalize(axis + Vec3d{e, -0.7 * e, 0.4 * e}));
    for (int k = 0; k < 2000; ++k) {  // Fibonacci's lattice
        const double z = 1 - (2 * k + 1) / 2000.0, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * k;
        list.push_back({r * std::cos(phi), r * std::sin(phi), z});
    }
    return list;
}

/// |a x b| of the derivatives by central differences: dω / (du dv) of a map of unit directions.
template <typename Direction>
double measured_jacobian(UV uv, const Direction& direction) {
    const double e = 1e-5;
    const Vec3d du = (direction(UV{uv.u + e, uv.v}) - direction(UV{uv.u - e, uv.v})) / (2 * e),
                dv = (direction(UV{uv.u, uv.v + e}) - direction(UV{uv.u, uv.v - e})) / (2 * e);
    return length(cross(du, dv));
}

}  // namespace

TEST_CASE("sphere map: the centre is +Z, right +X, up +Y; the reflection of OpenGL's eye vector") {
    const auto at = [](Vec3d d) { return sphere_map_uv(d); };
    CHECK(at({0, 0, 1}).u == 0.5);
    CHECK(at({0, 0, 1}).v == 0.5);
    CHECK(std::abs(at({1, 0, 0}).u - (0.5 + 0.5 * std::sqrt(0.5))) < 1e-15);
    CHECK(std::abs(at({0, 3, 0}).v - (0.5 - 0.5 * std::sqrt(0.5))) < 1e-15);
    for (const Vec3d& d : probes()) {
        // The specification's own m = 2 √(x^2 + y^2 + (z + 1)^2); s = x / m + 1/2, t = y / m + 1/2 upwards.
        const double m = 2 * std::sqrt(d.x * d.x + d.y * d.y + (d.z + 1) * (d.z + 1));
        if (d.z > -0.999) {
            CHECK(std::abs(at(d).u - (d.x / m + 0.5)) < 1e-12);
            CHECK(std::abs(1 - at(d).v - (d.y / m + 0.5)) < 1e-12);
        }
        CHECK(length(sphere_map_direction(at(d)) - d) < (d.z < -0.9999999 ? 1e-6 : 1e-8));
        // The ball's normal there mirrors the view of a camera far away on +Z.
        const DiscPoint p = disc_point(at(d));
        const Vec3d n{p.x, p.y, std::sqrt(std::max(0.0, 1 - p.squared()))}, view{0, 0, -1};
        CHECK(length(view - n * (2 * dot(view, n)) - d) < 1e-7);
    }
    for (const UV uv : {UV{0.5, 0.5}, {0.2, 0.6}, {0.8, 0.3}, {0.5, 0.03}})
        CHECK(std::abs(measured_jacobian(uv, sphere_map_direction) - k_sphere_map_jacobian) < 1e-6);
    CHECK(sphere_map_direction({0, 0}) == Vec3d{0, 0, -1});  // outside the disc
}

TEST_CASE("dual paraboloid: each half's formula, inverse everywhere, equal at the rim") {
    for (const Vec3d& d : probes()) {
        const ParaboloidPoint p = dual_paraboloid_point(d * 3.0);
        CHECK((p.half == ParaboloidHalf::front) == (d.z >= 0));
        CHECK(disc_point(p.uv).squared() < 1 + 1e-12);
        CHECK(length(paraboloid_direction(p.half, p.uv) - d) < 1e-14);
        // The picture continues beyond the rim.
        const auto other = p.half == ParaboloidHalf::front ? ParaboloidHalf::back : ParaboloidHalf::front;
        if (std::abs(d.z) < 0.9) CHECK(length(paraboloid_direction(other, paraboloid_uv(other, d)) - d) < 1e-12);
    }
    const Vec3d rim = normalize(Vec3d{0.6, 0.8, 0});
    const UV front = paraboloid_uv(ParaboloidHalf::front, rim), back = paraboloid_uv(ParaboloidHalf::back, rim);
    CHECK(front.u == back.u);  // both halves have +X at the right and +Y at the top
    CHECK(front.v == back.v);
    CHECK(std::abs(front.u - 0.8) < 1e-15);
    CHECK(std::abs(front.v - 0.1) < 1e-15);
    for (const UV uv : {UV{0.5, 0.5}, {0.2, 0.6}, {0.8, 0.3}, {0.5, 0.03}})
        for (const ParaboloidHalf half : {ParaboloidHalf::front, ParaboloidHalf::back})
            CHECK(std::abs(measured_jacobian(uv, [&](UV at) { return paraboloid_direction(half, at); }) -
                           paraboloid_jacobian(uv)) < 1e-6);
}
