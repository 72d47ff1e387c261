#include "filtering/direct/direct_sums.h"

#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "accuracy.h"
#include "filtering/direct/refined_rows.h"
#include "filtering/prefilter_checks.h"
#include "test.h"

#include <optional>

using namespace domelight;
using namespace domelight::test;

namespace {

/// The levels of Unreal's chain whose lobes are narrower than their texels.
FilterOptions narrow_levels() {
    FilterOptions options;
    for (const auto& [size, level] : {std::pair{128, 1}, {64, 2}, {32, 3}})
        options.specular.push_back({size, false, ZonalKernel::ggx(std::exp2((level - 7) / 1.2))});
    return options;
}

void check_accuracy(ImageView<const float> image, int random) {
    const auto rows = measure_levels(image, narrow_levels(), random);
    REQUIRE(rows.size() == 3);
    for (const Accuracy& row : rows) {
        CHECK_MESSAGE(row.rmse <= 3e-4, row.name << " (alpha " << row.width << "): RMSE " << row.rmse);
        CHECK_MESSAGE(row.largest <= 1e-2, row.name << " (alpha " << row.width << "): max " << row.largest << " at "
                                                    << row.where.x << " " << row.where.y << " " << row.where.z);
    }
}

}  // namespace

TEST_CASE("direct sums: Unreal's narrow levels are summed, levels with finer texels or wider lobes are not") {
    for (const LevelSpec& level : narrow_levels().specular) CHECK(DirectSums::takes_directly(level, Layout::cube));
    CHECK(DirectSums::takes_directly({128, false, {Lobe::ggx, 0.001}}, Layout::latlong));
    CHECK_FALSE(DirectSums::takes_directly({512, false, {Lobe::ggx, 0.0026}}, Layout::cube));
    CHECK_FALSE(DirectSums::takes_directly({64, false, {Lobe::ggx, 0.0076}}, Layout::cube));
    CHECK_FALSE(DirectSums::takes_directly({128, true, {}}, Layout::cube));
    CHECK_FALSE(DirectSums::takes_directly({16, false, {Lobe::phong_brdf, 1e5}}, Layout::cube));
}

TEST_CASE("direct sums: narrow lobes are the integral to 3e-4 RMS and 1e-2 at most, suns and noise, small and large") {
    check_accuracy(sun_image(256, 1e5, 0.4, 1.0), 100);
    check_accuracy(sun_image(1024, 1e5, 1.2, 4.0), 60);
    check_accuracy(noise_image(2048, 1024, 1, 50), 30);
    check_accuracy(noise_image(4096, 2048, 2, 200), 15);
    for (auto [width, height] : {std::pair{1, 1}, {2, 1}, {7, 5}, {62, 31}, {506, 253}}) {
        CAPTURE(width);
        check_accuracy(noise_image(width, height, 3, 50), 30);
    }
}

TEST_CASE("direct sums: narrow lobes over real environments are the integral") {
    for (const char* name : {"env_highres/spruit_sunrise_1k.hdr", "env_latlong/potsdamer_platz_1k.hdr",
                             "env_highres/spruit_sunrise_4k_from_ultrahdr.hdr"}) {
        const auto folder = data_folder();
        if (!folder || !std::filesystem::exists(*folder / name))
            return note_skip("DOMELIGHT_DATA has no real environments");
        CAPTURE(name);
        auto environment = open_environment({*folder / name});
        REQUIRE(environment);
        const auto image = read_latlong(**environment->rows());
        REQUIRE(image);
        check_accuracy(*image, 100);
    }
}

TEST_CASE("direct sums: a constant environment stays constant, in both layouts") {
    for (auto [width, height] : {std::pair{1, 1}, {126, 63}, {1000, 500}})
        for (const Layout layout : {Layout::cube, Layout::latlong}) {
            const ImageF image(width, height, 3, 0.7f);
            FilterOptions options = narrow_levels();
            options.layout = layout;
            ImageRowSource source(image);
            const auto result = prefilter(source, options);
            REQUIRE(result);
            double worst = 0;
            for (const FilteredMap& level : result->specular)
                for (const float p : level.pixels()) worst = std::max(worst, std::abs(p / 0.7f - 1.0));
            CHECK_MESSAGE(worst <= 1e-6, width << " x " << height << ": off by " << worst);
        }
}

TEST_CASE("direct sums: lat-long levels, and worlds that are turned, at the same directions") {
    const ImageF image = noise_image(256, 128, 7, 100);
    FilterOptions options;
    options.layout = Layout::latlong;
    options.world_to_source = rotation_y(0.7) * Mat3{{Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}}};
    options.specular = {{16, false, {Lobe::ggx, 0.004}}};
    REQUIRE(DirectSums::takes_directly(options.specular[0], options.layout));
    ImageRowSource source(image);
    const auto result = prefilter(source, options);
    REQUIRE(result);
    std::vector<Vec3d> directions;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            directions.push_back(options.world_to_source * latlong_direction({(x + 0.5) / 32, (y + 0.5) / 16}));
    const auto truth = convolve_exactly(image, options.specular[0].kernel, directions);
    for (std::size_t i = 0; i < directions.size(); ++i)
        CHECK(std::abs(result->specular[0].pixels()[3 * i] / truth[i].x - 1) < 3e-3);
}

TEST_CASE("direct sums: the same bits on any number of threads and for rows handed over in any way") {
    const ImageF image = noise_image(600, 300, 5, 100);
    FilterOptions options = narrow_levels();
    std::optional<std::vector<FilteredMap>> first;
    for (const auto& [threads, rows] : {std::pair{1, 64}, {2, 1}, {3, 7}, {8, 300}}) {
        options.threads = threads;
        DirectSums sums(600, 300, options, {0, 1, 2});
        for (int y = 0; y < 300; y += rows) sums.add_rows(std::as_const(image).view().rows(y, std::min(rows, 300 - y)));
        auto maps = sums.finish(BrightSplit(600, 300));
        if (!first) {
            first = std::move(maps);
            continue;
        }
        for (std::size_t l = 0; l < maps.size(); ++l)
            CHECK(std::equal(maps[l].pixels().begin(), maps[l].pixels().end(), (*first)[l].pixels().begin()));
    }
}

TEST_CASE("direct sums: instruction sets agree to 1e-6") {
    const ImageF image = noise_image(512, 256, 5, 100);
    FilterOptions options = narrow_levels();
    options.specular.erase(options.specular.begin());  // the portable code takes long for its 98304 texels
    check_instruction_sets_agree(image, options);
}

TEST_CASE("refined rows: the bilinear image at the new centres, across the seam and beyond the outermost centres") {
    const int width = 7, height = 4;
    const ImageF image = noise_image(width, height, 9);
    for (const int factor : {1, 3, 5})
        for (const int at_once : {1, 3, 4}) {
            RefinedRows rows(width, height, factor);
            REQUIRE(rows.height() == factor * height);
            std::vector<float> planes(3 * std::size_t(rows.width()));
            ImageF chunk(width, at_once, 3);
            for (int y = 0; y < height; y += at_once) {
                const int count = std::min(at_once, height - y);
                std::copy_n(image.row(y), 3 * width * count, chunk.row(0));  // over the rows before
                rows.add_rows(std::as_const(chunk).view().rows(0, count));
                for (int k = rows.next_row(); k < rows.end_row(); ++k) {
                    rows.read(k, planes.data(), rows.width());
                    for (int x = 0; x < rows.width(); ++x) {
                        const double u = (x + 0.5) / factor - 0.5, v = std::clamp((k + 0.5) / factor - 0.5, 0.0, 3.0);
                        const int i = int(std::floor(u)), j = std::min(int(v), 2);
                        for (int c = 0; c < 3; ++c) {
                            const auto across = [&](int row) {
                                const double a = image.at((i + width) % width, row)[c],
                                             b = image.at((i + 1) % width, row)[c];
                                return a + (u - i) * (b - a);
                            };
                            const double expected = across(j) + (v - j) * (across(j + 1) - across(j));
                            CHECK(std::abs(planes[std::size_t(c * rows.width() + x)] - expected) < 1e-6);
                        }
                    }
                }
                rows.advance_to(rows.end_row());
            }
            CHECK(rows.next_row() == rows.height());
        }
}
