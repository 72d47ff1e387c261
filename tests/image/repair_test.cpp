#include "image/repair.h"

#include "image/colour_primaries.h"
#include "test.h"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace domelight;

namespace {

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_inf = std::numeric_limits<float>::infinity();

/// A row repaired as an image of its own.
std::vector<float> repaired(std::vector<float> row, RepairReport& report, const RepairOptions& options = {}) {
    repair_image({row.data(), int(row.size() / 3), 1, 3}, options, report);
    return row;
}

const RepairOptions k_clamp{.negatives = Negatives::clamp};

/// An image of 40 x 60 texels of 1.
ImageF even_image() {
    return ImageF(40, 60, 3, 1.0f);
}

Vec3d sum_of(
    const ImageF& image, const std::function<double(int)>& weight = [](int) { return 1.0; }) {
    Vec3d sum;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            sum += Vec3d(image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]) * weight(y);
    return sum;
}

}  // namespace

TEST_CASE("repair: good texels stay as they are, bit for bit") {
    const std::vector<float> row{0, -0.0f, 1e-40f, 1, 65504, 0x1p100f};
    RepairReport report;
    CHECK(repaired(row, report) == row);
    CHECK(report.repaired() == 0);
    CHECK(report.lines().empty());
}

TEST_CASE("repair: a texel with a NaN becomes the mean of its nearest good neighbours") {
    // Texels 1 and 2 of four are bad: between 0 and 3, which are 1 and 5 in every channel.
    RepairReport report;
    CHECK(repaired({1, 1, 1, k_nan, 7, 7, 7, 7, k_nan, 5, 5, 5}, report) ==
          std::vector<float>{1, 1, 1, 3, 3, 3, 3, 3, 3, 5, 5, 5});
    CHECK(report.not_a_number == 2);
    CHECK(report.repaired() == 2);

    // At the end of the row the next good texel lies across the seam, if there is any.
    for (const bool wraps : {true, false})
        CHECK(repaired({1, 1, 1, 5, 5, 5, k_nan, k_nan, k_nan}, report, {.wraps = wraps})[6] == (wraps ? 3 : 5));
    CHECK(repaired({k_nan, 1, 2, k_nan, 3, 4}, report) == std::vector<float>(6, 0.0f));
}

TEST_CASE("repair: rows of no numbers lie between the rows above and below") {
    RepairReport report;
    ImageF image(4, 9, 3);
    for (int y = 0; y < 9; ++y) std::fill_n(image.row(y), 12, y == 0 || y == 4 || y == 5 || y == 8 ? k_nan : float(y));
    image.at(2, 6)[0] = k_nan;  // is not taken for a row above it
    repair_image(image, {}, report);
    for (int x = 0; x < 4; ++x) {
        CHECK(*image.at(x, 0) == 1);
        CHECK(*image.at(x, 4) == doctest::Approx(x == 2 ? 3 : 4));
        CHECK(*image.at(x, 5) == doctest::Approx(x == 2 ? 3 : 5));
        CHECK(*image.at(x, 6) == 6);
        CHECK(*image.at(x, 8) == 7);
    }
    CHECK(report.not_a_number == 17);
    ImageF nothing(4, 30, 3, k_nan);
    repair_image(nothing, {}, report);
    CHECK(sum_of(nothing) == Vec3d());
}

TEST_CASE("repair: infinite becomes the format's largest value, negative becomes 0, and both are counted") {
    RepairReport report;
    RepairOptions half = k_clamp;
    half.largest = 65504;
    CHECK(repaired({k_inf, 2, 3, -k_inf, 2, 3, -1, -0.5f, 3, 70000, 1, 1, 1, 1, 1}, report, half) ==
          std::vector<float>{65504, 2, 3, 0, 2, 3, 0, 0, 3, 65504, 1, 1, 1, 1, 1});
    CHECK(report.infinite == 3);
    CHECK(report.negative == 1);
    CHECK(report.negative_radiance == -1);
    CHECK(report.added.y == 0.5);

    // A neighbour of a NaN is mended first.
    CHECK(repaired({k_inf, 0, 0, k_nan, 0, 0}, report, {.largest = 8}) == std::vector<float>{8, 0, 0, 8, 0, 0});
}

TEST_CASE("repair: an infinite float becomes the largest finite value near it") {
    RepairReport report;
    ImageF image = even_image();
    image.at(20, 30)[0] = k_inf;
    image.at(21, 31)[0] = 40;
    image.at(25, 30)[0] = 90;  // not as near
    repair_image(image, {}, report);
    CHECK(image.at(20, 30)[0] == 40);
    CHECK(image.at(20, 30)[1] == 1);
    CHECK(report.infinite == 1);
    // A sun of infinite texels takes the light round it, and 3e38 is no light either.
    image = even_image();
    for (int y = 28; y < 34; ++y)
        for (int x = 18; x < 24; ++x) std::fill_n(image.at(x, y), 3, (x + y) % 2 ? k_inf : 3e38f);
    image.at(24, 30)[2] = 7;
    repair_image(image, {}, report);
    CHECK(image.at(23, 30)[2] == 7);
    for (const float v : image.pixels()) CHECK((v >= 1 && v <= 7));
    ImageF everything(4, 30, 3, k_inf);
    repair_image(everything, {}, report);
    CHECK(sum_of(everything) == Vec3d());
}

TEST_CASE("repair: negative texels are balanced by the light round them") {
    // A sun with ringing beside it, near the seam.
    ImageF image = even_image();
    image.at(0, 30)[2] = 5000, image.at(39, 30)[2] = -900, image.at(1, 31)[2] = -300, image.at(5, 32)[2] = -0.5f;
    const ImageF stored = image;
    const auto weight = [](int y) { return 1 + 0.01 * y; };
    RepairReport report;
    repair_image(image, {.weight = weight}, report);
    const Vec3d before = sum_of(stored, weight), after = sum_of(image, weight);
    CHECK(after.z == doctest::Approx(before.z));
    CHECK(after.x == before.x);
    CHECK(report.negative == 3);
    CHECK(report.negative_radiance == -900);
    CHECK(report.light.z == doctest::Approx(before.z));
    CHECK(report.share_added() == Vec3d());
    for (const float v : image.pixels()) CHECK(v >= 0);
    CHECK(image.at(0, 30)[2] > 3500);  // the sun pays
    CHECK(image.at(30, 30)[2] == 1);   // what is far does not
    CHECK(image.at(5, 32)[2] == 0);
    // By clamping, the light grows by what was negative.
    image = stored;
    RepairReport clamped;
    RepairOptions clamp = k_clamp;
    clamp.weight = weight;
    repair_image(image, clamp, clamped);
    CHECK(clamped.added.z == doctest::Approx(sum_of(image, weight).z - before.z));
    CHECK(clamped.lines().size() == 1);
    // Kept ones are counted all the same.
    image = stored;
    RepairReport kept;
    repair_image(image, {.negatives = Negatives::keep}, kept);
    CHECK(std::equal(image.pixels().begin(), image.pixels().end(), stored.pixels().begin()));
    CHECK(kept.negative == 3);
    CHECK(kept.negatives_kept);
}

TEST_CASE("repair: a negative texel that its neighbours cannot pay for takes nothing from them") {
    ImageF image = even_image();
    image.at(20, 30)[0] = -1e6f;
    RepairReport report;
    repair_image(image, {}, report);
    CHECK(image.at(20, 30)[0] == 0);
    CHECK(image.at(21, 30)[0] == 1);
    CHECK(report.added.x == doctest::Approx(1e6));
}

TEST_CASE("repair: the rows that are read at once and the threads change nothing") {
    const auto image = [] {
        ImageF made(24, 100, 3);
        for (int y = 0; y < 100; ++y)
            for (int i = 0; i < 72; ++i) {
                const int n = (i * 37 + y * 101) % 97;
                made.row(y)[i] = n == 3 ? k_nan : n == 5 ? k_inf : n < 20 ? -0.1f * float(n) : float(n);
            }
        for (const int y : {0, 40, 41, 99}) std::fill_n(made.row(y), 72, k_nan);
        return made;
    }();
    const auto read = [&](int rows_a_read, int threads) {
        int next = 0;
        RowRepair repair(24, 100, {.threads = threads}, [&](ImageView<float> rows) -> Result<void> {
            for (int y = 0; y < rows.height; ++y) std::copy_n(image.row(next++), 72, rows.row(y));
            return {};
        });
        ImageF out(24, 100, 3);
        RepairReport report;
        for (int y = 0; y < 100; y += rows_a_read)
            REQUIRE(repair.next(out.view().rows(y, std::min(rows_a_read, 100 - y)), report));
        CHECK(report.not_a_number > 4 * 24);
        return out;
    };
    const ImageF whole = read(100, 1);
    for (const float v : whole.pixels()) CHECK((v >= 0 && v <= 97));
    for (const int rows : {1, 7, 33})
        for (const int threads : {1, 3}) {
            const ImageF other = read(rows, threads);
            CHECK(std::equal(other.pixels().begin(), other.pixels().end(), whole.pixels().begin()));
        }
}

TEST_CASE("repair: exposure multiplies, and nothing passes the largest radiance") {
    RepairReport report;
    RepairOptions four = k_clamp;
    four.scale = 4;
    CHECK(repaired({1, 2, 3, 0x1p99f, 5, -2}, report, four) == std::vector<float>{4, 8, 12, k_largest_radiance, 20, 0});
    CHECK(report.negative_radiance == -8);
    CHECK(report.infinite == 1);
    CHECK(repaired({1, 2, 3}, report, {.scale = 0.5f}) == std::vector<float>{0.5f, 1, 1.5f});
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
