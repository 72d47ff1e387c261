#include "domelight/environment/sky/sky.h"
#include "domelight/projection/projection.h"

#include "image/font.h"
#include "test.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace domelight;

namespace {

struct Axis {
    Vec3d forward, right, up;
};

// As docs/conventions.md has them: right = forward x up.
const Axis k_axes[] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                       {{0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}, {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
                       {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

Vec3f look(const ImageF& image, const Axis& a, double x, double y) {
    const UV uv = latlong_uv(a.forward + a.right * x + a.up * y);
    const float* p = image.at(std::min(int(uv.u * image.width()), image.width() - 1),
                              std::min(int(uv.v * image.height()), image.height() - 1));
    return {p[0], p[1], p[2]};
}

bool white(const Vec3f& v) {
    return std::min({v.x, v.y, v.z}) > 0.9f;
}

}  // namespace

TEST_CASE("make_axes_environment: six colours, and marks that give a mirror image or a turn away") {
    const ImageF image = make_axes_environment(512);
    std::vector<Vec3f> colours;
    for (const Axis& a : k_axes) {
        const Vec3f colour = look(image, a, 0, -0.4);
        CHECK_FALSE(white(colour));
        for (const Vec3f& other : colours) CHECK(length(colour - other) > 0.3f);
        colours.push_back(colour);
        CHECK(white(look(image, a, 0, 0.42)));         // the arrow, up
        CHECK(white(look(image, a, 0.30, 0.32)));      // the dot, to the upper right
        CHECK(look(image, a, -0.30, 0.32) == colour);  // and no other
        CHECK(look(image, a, 0.30, -0.36) == colour);
        // The sign, left of the letter: its bar, and above that the rest of a plus.
        const char letter = a.forward.x != 0 ? 'X' : a.forward.y != 0 ? 'Y' : 'Z';
        const double sign = -0.26 * font_field_advance(letter);
        CHECK(white(look(image, a, sign, -0.06)));
        CHECK(white(look(image, a, sign, 0.05)) == (dot(a.forward, {1, 1, 1}) > 0));
    }
}

TEST_CASE("make_axes_environment: readable from 64 rows up, finite everywhere") {
    for (int height : {1, 2, 64, 100}) {
        const ImageF image = make_axes_environment(height);
        CHECK(image.width() == 2 * height);
        CHECK(std::all_of(image.pixels().begin(), image.pixels().end(), [](float v) { return v >= 0 && v <= 1; }));
    }
    const ImageF small = make_axes_environment(64);
    // The disc's colour on either side of the upright strokes of +X's plus.
    const Vec3f bar = look(small, k_axes[0], -0.19, -0.03), beside = look(small, k_axes[0], -0.3, 0.1);
    CHECK(bar.y > 0.6f);
    CHECK(beside.y < 0.2f);
}
