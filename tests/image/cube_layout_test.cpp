#include "domelight/image/cube_layout.h"

#include "domelight/projection/projection.h"

#include "test.h"

using namespace domelight;

namespace {

/// A cube whose texels hold their directions.
Cubemap direction_cube(int size) {
    Cubemap cube(size);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3d d = cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size});
                float* texel = cube.face(f).at(x, y);
                texel[0] = float(d.x), texel[1] = float(d.y), texel[2] = float(d.z);
            }
    return cube;
}

/// Whether two texels look almost the same way.
bool near(const float* a, const float* b, int size) {
    const Vec3d u = normalize(Vec3d{a[0], a[1], a[2]}), v = normalize(Vec3d{b[0], b[1], b[2]});
    return length(u - v) < 2.0 / size;
}

}  // namespace

TEST_CASE("cube_layout: in a cross neighbouring faces meet at their common edge") {
    const int n = 16;
    const Cubemap cube = direction_cube(n);
    const ImageF cross = cube_layout(cube, "cross");
    REQUIRE(cross.width() == 4 * n);
    REQUIRE(cross.height() == 3 * n);
    for (int y = n; y < 2 * n; ++y)
        for (int x = 1; x < 4 * n; ++x) CHECK(near(cross.at(x - 1, y), cross.at(x, y), n));
    for (int y = 1; y < 3 * n; ++y)
        for (int x = n; x < 2 * n; ++x) CHECK(near(cross.at(x, y - 1), cross.at(x, y), n));
    CHECK(cross.at(0, 0)[0] == 0);  // the corners are black
    // The centre of the picture's second column looks along +Z.
    CHECK(cross.at(n + n / 2, n + n / 2)[2] == 1);

    const ImageF vertical = cube_layout(cube, "vertical-cross");
    REQUIRE(vertical.width() == 3 * n);
    REQUIRE(vertical.height() == 4 * n);
    for (int y = 1; y < 4 * n; ++y)
        for (int x = n; x < 2 * n; ++x) CHECK(near(vertical.at(x, y - 1), vertical.at(x, y), n));
}

TEST_CASE("cube_layout: strips hold the faces in order") {
    const int n = 4;
    const Cubemap cube = direction_cube(n);
    const ImageF strip = cube_layout(cube, "strip"), vertical = cube_layout(cube, "vertical-strip");
    REQUIRE(strip.width() == 6 * n);
    REQUIRE(vertical.height() == 6 * n);
    for (int f = 0; f < 6; ++f)
        for (int c = 0; c < 3; ++c) {
            CHECK(strip.at(f * n + 1, 2)[c] == cube.face(f).at(1, 2)[c]);
            CHECK(vertical.at(1, f * n + 2)[c] == cube.face(f).at(1, 2)[c]);
        }
    CHECK(cube_layout(cube, "sphere").empty());
}
