#include "domelight/bake/brdf_file.h"

#include "domelight/texture/texture.h"

#include "test.h"

#include <cmath>

using namespace domelight;

namespace {

/// A table as it is read back from its file.
ImageF read_back(const std::filesystem::path& file, const BrdfFileOptions& options) {
    REQUIRE(write_brdf_file(file, options));
    const auto texture = read_texture(file);
    REQUIRE(texture);
    return decode_texture(*texture, 0, 0);
}

double largest_difference(const ImageF& a, const ImageF& b, int channel_a, int channel_b) {
    REQUIRE(a.width() == b.width());
    REQUIRE(a.height() == b.height());
    double largest = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            largest = std::max(largest, std::abs(double(a.at(x, y)[channel_a]) - b.at(x, y)[channel_b]));
    return largest;
}

}  // namespace

TEST_CASE("brdf_file: every texture container gives the table back, in each form") {
    const test::TemporaryFolder folder;
    for (const std::string name : {"a.ktx2", "a.ktx", "a.dds"})
        for (const bool single : {false, true}) {
            INFO(name << (single ? ", float" : ", half"));
            BrdfFileOptions options{.size = 16, .single_precision = single};
            const ImageF table = brdf_table(options);
            const double most = single ? 0 : 0x1p-12;  // half floats below 1, rounded
            const ImageF scale_bias = read_back(folder / name, options);
            CHECK(scale_bias.channels() == 2);
            for (int c = 0; c < 2; ++c) CHECK(largest_difference(scale_bias, table, c, c) <= most);

            options.form = BrdfForm::multiscatter;  // (bias, scale + bias)
            const ImageF multiscatter = read_back(folder / name, options);
            CHECK(largest_difference(multiscatter, table, 0, 1) <= most);
            double worst = 0;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x)
                    worst = std::max(
                        worst, std::abs(double(multiscatter.at(x, y)[1]) - table.at(x, y)[0] - table.at(x, y)[1]));
            CHECK(worst <= most + 1e-7);

            options.form = BrdfForm::scale_bias_charlie;
            const ImageF charlie = read_back(folder / name, options);
            // The albedo of sheen goes up to 2.8 here, and halves from 2 to 4 are 2^-9 apart.
            for (int c = 0; c < 3; ++c) CHECK(largest_difference(charlie, table, c, c) <= (c == 2 ? 4 : 1) * most);
        }
}

TEST_CASE("brdf_file: Monte Carlo comes near the exact table with each sequence") {
    BrdfFileOptions options{.size = 8};
    const ImageF exact = brdf_table(options);
    for (const Sequence sequence : {Sequence::hammersley, Sequence::sobol, Sequence::r2}) {
        options.points = PointSet{sequence, 3, 65536};
        const ImageF estimate = brdf_table(options);
        for (int c = 0; c < 2; ++c) CHECK(largest_difference(estimate, exact, c, c) < 0.003);
    }
}

TEST_CASE("brdf_file: what cannot be written is an error that names it") {
    const test::TemporaryFolder folder;
    CHECK(write_brdf_file(folder / "a.ktx2", {.size = 0}).error().where == "`size`");
    CHECK(write_brdf_file(folder / "a.ktx2", {.size = 5000}).error().where == "`size`");
    CHECK(write_brdf_file(folder / "a.ktx2", {.form = BrdfForm::none}).error().where == "`form`");
    CHECK(write_brdf_file(folder / "a.tga", {.size = 4}).error().what.find(".tga") != std::string::npos);
}
