#include "domelight/io/write_image.h"

#include "io/io_helpers.h"
#include "test.h"

#include <png.h>

using namespace domelight;
using namespace domelight::test;

TEST_CASE("write_png: pixels of 1, 3 and 4 channels come back") {
    const TemporaryFolder folder;
    const auto file = folder / "a.png";
    for (int channels : {1, 3, 4})
        for (int level : {0, 3, 9}) {
            Image<std::uint8_t> image(37, 21, channels);
            std::uint32_t state = 9;
            for (auto& p : image.pixels()) p = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
            // A view with gaps between its rows.
            const ImageView<const std::uint8_t> view(image.view().data, 30, 21, channels, 37 * channels);
            REQUIRE(write_png(file, view, level));
            png_image png = {};
            png.version = PNG_IMAGE_VERSION;
            REQUIRE(png_image_begin_read_from_file(&png, file.c_str()));
            CHECK(png.width == 30);
            CHECK(png.height == 21);
            png.format = channels == 1 ? PNG_FORMAT_GRAY : channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
            std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(png));
            REQUIRE(png_image_finish_read(&png, nullptr, back.data(), 0, nullptr));
            for (int y = 0; y < 21; ++y)
                REQUIRE(std::equal(view.row(y), view.row(y) + 30 * channels, back.begin() + y * 30 * channels));
        }
}

TEST_CASE("write_png: says that it is sRGB") {
    const TemporaryFolder folder;
    REQUIRE(write_png(folder / "a.png", Image<std::uint8_t>(4, 4, 3)));
    const auto bytes = file_bytes(folder / "a.png");
    CHECK(std::string(bytes.begin(), bytes.end()).find("sRGB") != std::string::npos);
}

TEST_CASE("write_png: a picture libpng refuses is one error") {
    const TemporaryFolder folder;
    const auto written = write_png(folder / "a.png", ImageView<const std::uint8_t>(nullptr, 0, 0, 3));
    REQUIRE(!written);
    CHECK(written.error().what.find("libpng") != std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}
