#include "projection/latlong_convention.h"

#include "domelight/image/image.h"
#include "domelight/image/row_source.h"
#include "domelight/projection/projection.h"

#include "projection/latlong_regrid.h"
#include "test.h"

#include <cmath>

using namespace domelight;

namespace {

/// Where on the image a world direction is found.
UV uv_in(const LatlongConvention& c, const Vec3d& world) {
    return latlong_uv(c.world_to_default() * world);
}

double determinant(const Mat3& m) {
    return dot(m.row[0], cross(m.row[1], m.row[2]));
}

}  // namespace

TEST_CASE("lat-long conventions: centre, right and up are where the name says") {
    struct {
        const char* name;
        Vec3d centre, right;
    } const expected[] = {{"default", {1, 0, 0}, {0, 0, 1}},    {"usd", {0, 0, 1}, {-1, 0, 0}},
                          {"mitsuba", {0, 0, 1}, {-1, 0, 0}},   {"openexr", {0, 0, 1}, {-1, 0, 0}},
                          {"materialx", {0, 0, -1}, {1, 0, 0}}, {"mod", {-1, 0, 0}, {0, 0, -1}}};
    for (const auto& e : expected) {
        const auto c = latlong_convention(e.name);
        REQUIRE(c);
        const UV centre = uv_in(*c, e.centre), right = uv_in(*c, e.right), top = uv_in(*c, {0, 1, 0});
        CHECK(std::abs(centre.u - 0.5) < 1e-12);
        CHECK(std::abs(centre.v - 0.5) < 1e-12);
        CHECK(std::abs(right.u - 0.75) < 1e-12);
        CHECK(std::abs(top.v) < 1e-12);
        CHECK(determinant(c->world_to_default()) == 1);  // all of them are seen from inside
    }
}

TEST_CASE("lat-long conventions: the published formulas of each name") {
    const auto wrapped = [](double a, double b) { return std::abs(std::remainder(a - b, 1.0)); };
    for (double phi = -3; phi < 3.1; phi += 0.37)
        for (double theta = 0.2; theta < 3; theta += 0.45) {
            const Vec3d d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            const double tau = 2 * k_pi;
            // Mitsuba: u = atan2(x, -z) / 2π. OpenEXR: longitude atan2(x, z) runs from π at the left to -π at the
            // right. MaterialX: u = atan2(x, -z) / 2π + 1/2. The courses' shader form, z up there: u = 1 - mod(φ /
            // 2π, 1), φ = atan2(-z, x) here.
            CHECK(wrapped(uv_in(*latlong_convention("mitsuba"), d).u, std::atan2(d.x, -d.z) / tau) < 1e-12);
            CHECK(wrapped(uv_in(*latlong_convention("openexr"), d).u, 0.5 - std::atan2(d.x, d.z) / tau) < 1e-12);
            CHECK(wrapped(uv_in(*latlong_convention("materialx"), d).u, 0.5 + std::atan2(d.x, -d.z) / tau) < 1e-12);
            CHECK(wrapped(uv_in(*latlong_convention("mod"), d).u, 1 - std::atan2(-d.z, d.x) / tau) < 1e-12);
        }
}

TEST_CASE("lat-long conventions: axes can be said, mirrored and turned over as well") {
    const auto same = latlong_convention("centre=+X,right=+Z");
    REQUIRE(same);
    CHECK(same->world_to_default() == Mat3());
    const auto mirrored = latlong_convention("center=x,right=-z,up=+y");
    REQUIRE(mirrored);
    CHECK(determinant(mirrored->world_to_default()) == -1);
    const auto z_up = latlong_convention("centre=+X,right=-Y,up=+Z");
    REQUIRE(z_up);
    CHECK(std::abs(uv_in(*z_up, {0, 0, 1}).v) < 1e-12);
    CHECK(std::abs(uv_in(*z_up, {0, -1, 0}).u - 0.75) < 1e-12);
    for (const char* wrong : {"centre=+X", "centre=+X,right=-X", "centre=+Y,right=+X", "centre=+X,right=+Q", "sideways",
                              "", "centre=+X,left=+Z", "centre=+X,right"}) {
        const auto refused = latlong_convention(wrong);
        REQUIRE_FALSE(refused);
        CHECK(!refused.error().what.empty());
    }
}

TEST_CASE("regrid: samples on the poles and edges are read where they lie") {
    // A function that is linear in the row and column position is reproduced exactly, up to float.
    using Grid = LatlongConvention::Grid;
    const int width = 16, height = 8;
    for (const Grid grid : {Grid::centres, Grid::rows_on_poles, Grid::both_on_edges}) {
        ImageF samples(width, height, 3);
        for (int j = 0; j < height; ++j)
            for (int i = 0; i < width; ++i) {
                const double u = grid == Grid::both_on_edges ? double(i) / (width - 1) : (i + 0.5) / width;
                const double v = grid == Grid::centres ? (j + 0.5) / height : double(j) / (height - 1);
                samples.at(i, j)[0] = float(u), samples.at(i, j)[1] = float(v), samples.at(i, j)[2] = float(u * v);
            }
        const auto rows = regrid_latlong(std::make_unique<ImageRowSource>(samples.view()), grid);
        ImageF out(width, height, 3);
        for (int y = 0; y < height; y += 3) REQUIRE(rows->read(out.view().rows(y, std::min(3, height - y))));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double u = (x + 0.5) / width, v = (y + 0.5) / height;
                CHECK(std::abs(out.at(x, y)[0] - u) < 1e-6);
                CHECK(std::abs(out.at(x, y)[1] - v) < 1e-6);
                CHECK(std::abs(out.at(x, y)[2] - u * v) < 1e-6);
            }
    }
    // One row: nothing to interpolate.
    ImageF one(2, 1, 3, 4.0f);
    const auto rows = regrid_latlong(std::make_unique<ImageRowSource>(one.view()), Grid::both_on_edges);
    ImageF out(2, 1, 3);
    REQUIRE(rows->read(out.view()));
    for (const float v : out.pixels()) CHECK(v == 4);
}
