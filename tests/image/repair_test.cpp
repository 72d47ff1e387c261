#include "image/repair.h"

#include "image/colour_primaries.h"
#include "test.h"

#include <cmath>
#include <limits>
#include <vector>

using namespace domelight;

namespace {

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_inf = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("repair: good texels stay as they are, bit for bit") {
    std::vector<float> row{0, -0.0f, 1e-40f, 1, 65504, 0x1p100f};
    const std::vector<float> before = row;
    RepairReport report;
    repair_row(row, {}, report);
    CHECK(row == before);
    CHECK(report.repaired() == 0);
}

TEST_CASE("repair: a texel with a NaN becomes the mean of its nearest good neighbours") {
    // Texels 1 and 2 of four are bad: between 0 and 3, which are 1 and 5 in every channel.
    std::vector<float> row{1, 1, 1, k_nan, 7, 7, 7, 7, k_nan, 5, 5, 5};
    RepairReport report;
    repair_row(row, {}, report);
    CHECK(row == std::vector<float>{1, 1, 1, 3, 3, 3, 3, 3, 3, 5, 5, 5});
    CHECK(report.not_a_number == 2);
    CHECK(report.repaired() == 2);

    // At the end of the row the next good texel lies across the seam, if there is any.
    for (const bool wraps : {true, false}) {
        std::vector<float> end{1, 1, 1, 5, 5, 5, k_nan, k_nan, k_nan};
        repair_row(end, {.wraps = wraps}, report);
        CHECK(end[6] == (wraps ? 3 : 5));
    }
    std::vector<float> all{k_nan, 1, 2, k_nan, 3, 4};
    repair_row(all, {}, report);
    CHECK(all == std::vector<float>(6, 0.0f));
}

TEST_CASE("repair: infinite becomes the format's largest value, negative becomes 0, and both are counted") {
    std::vector<float> row{k_inf, 2, 3, -k_inf, 2, 3, -1, -0.5f, 3, 70000, 1, 1, 1, 1, 1};
    RepairReport report;
    repair_row(row, {.largest = 65504}, report);
    CHECK(row == std::vector<float>{65504, 2, 3, 0, 2, 3, 0, 0, 3, 65504, 1, 1, 1, 1, 1});
    CHECK(report.infinite == 3);
    CHECK(report.negative == 1);
    CHECK(report.negative_radiance == -1);

    // A neighbour of a NaN is mended first.
    std::vector<float> both{k_inf, 0, 0, k_nan, 0, 0};
    repair_row(both, {.largest = 8}, report);
    CHECK(both == std::vector<float>{8, 0, 0, 8, 0, 0});
}

TEST_CASE("repair: exposure multiplies, and nothing passes the largest radiance") {
    std::vector<float> row{1, 2, 3, 0x1p99f, k_inf, -2};
    RepairReport report;
    repair_row(row, {.scale = 4}, report);
    CHECK(row == std::vector<float>{4, 8, 12, k_largest_radiance, k_largest_radiance, 0});
    CHECK(report.negative_radiance == -8);
    std::vector<float> good{1, 2, 3};
    repair_row(good, {.scale = 0.5f}, report);
    CHECK(good == std::vector<float>{0.5f, 1, 1.5f});
}

TEST_CASE("primaries: Rec. 709 to XYZ is the published matrix, and the conversion to itself the identity") {
    const Mat3 m = *rgb_to_xyz({});
    // IEC 61966-2-1, four digits.
    const double published[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    for (int i = 0; i < 3; ++i) {
        const double row[3] = {m.row[i].x, m.row[i].y, m.row[i].z};
        for (int j = 0; j < 3; ++j) CHECK(std::abs(row[j] - published[i][j]) < 1e-4);
    }
    CHECK(is_nearly_identity(*rgb_to_rec709({})));
    CHECK(is_nearly_identity(xyz_to_rec709() * m));
}

TEST_CASE("primaries: grey stays grey whatever the white, and a red light keeps its chromaticity") {
    const ColourPrimaries aces{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, {0.32168, 0.33767}};
    const Vec3d grey = *rgb_to_rec709(aces) * Vec3d{1, 1, 1};
    CHECK(length(grey - Vec3d{1, 1, 1}) < 1e-9);
    // The white is that of Rec. 709, so there is no adaptation and XYZ agrees.
    const ColourPrimaries p3{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};
    const Vec3d red = *rgb_to_xyz({}) * (*rgb_to_rec709(p3) * Vec3d{1, 0, 0});
    CHECK(std::abs(red.x / (red.x + red.y + red.z) - 0.680) < 1e-9);
    CHECK(std::abs(red.y / (red.x + red.y + red.z) - 0.320) < 1e-9);
    // The published Bradford adaptation of ACES' white to D65 (AP0 to Rec. 709), to the digits usually printed.
    const Vec3d ap0_red = *rgb_to_rec709(aces) * Vec3d{1, 0, 0};
    CHECK(std::abs(ap0_red.x - 2.5217) < 2e-3);
    CHECK(std::abs(ap0_red.y - -0.2765) < 2e-3);

    CHECK(!rgb_to_rec709({{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
    CHECK(!rgb_to_rec709({{0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}}));
    CHECK(!rgb_to_rec709({{k_nan, 0.3}, {0.3, 0.6}, {0.1, 0.1}, {0.3, 0.3}}));
}
