#include "domelight/projection.h"

#include "test.h"

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
