#include "domelight/io/write_image.h"

#include "io/io_helpers.h"
#include "io/picture/texture_image.h"
#include "test.h"

#include <algorithm>
#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

/// Smooth gradients in every channel, with a red square whose edges would be blurred if colour were stored at half
/// resolution.
Image<std::uint8_t> shades(int width, int height, int channels) {
    Image<std::uint8_t> image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] = std::uint8_t(128 + 100 * std::sin(0.05 * (c + 1) * x + 0.07 * y));
    for (int y = 16; channels == 3 && y < std::min(32, height); ++y)
        for (int x = 17; x < std::min(30, width); ++x)
            image.at(x, y)[0] = 255, image.at(x, y)[1] = image.at(x, y)[2] = 0;
    return image;
}

}  // namespace

TEST_CASE("write_jpeg: pictures of 1 and 3 channels come back within the loss of quality 92") {
    const TemporaryFolder folder;
    for (const int channels : {1, 3}) {
        const Image<std::uint8_t> image = shades(61, 43, channels);
        // A view with gaps between its rows.
        const ImageView<const std::uint8_t> view(image.view().data, 50, 43, channels, 61 * channels);
        REQUIRE(write_jpeg(folder / "a.jpg", view));
        const auto back = decode_texture_image(file_bytes(folder / "a.jpg"));
        REQUIRE(back);
        REQUIRE(back->width == 50);
        REQUIRE(back->height == 43);
        double sum = 0;
        for (int y = 0; y < 43; ++y)
            for (int x = 0; x < 50; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double difference = back->rgba[std::size_t(y * 50 + x) * 4 + std::size_t(c)] -
                                              double(view.at(x, y)[channels == 3 ? c : 0]);
                    sum += difference * difference;
                }
        // Measured: 0.6 for grey, 1.5 for colour; with colour at half resolution it would be 6.3.
        CHECK(std::sqrt(sum / (3 * 43 * 50)) < 3);
    }
}

TEST_CASE("write_jpeg: opacity and sizes that the format cannot hold are errors, and no file is left") {
    const TemporaryFolder folder;
    const auto transparent = write_jpeg(folder / "a.jpg", Image<std::uint8_t>(4, 4, 4).view());
    REQUIRE(!transparent);
    CHECK(transparent.error().what.find("1 or 3 channels, not 4") != std::string::npos);
    const auto wide = write_jpeg(folder / "a.jpg", Image<std::uint8_t>(65501, 1, 1).view());
    REQUIRE(!wide);
    CHECK(wide.error().what.find("65500") != std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("write_screen_picture: the name's ending chooses the format, in any case") {
    const TemporaryFolder folder;
    const auto starts = [&](const char* name) {
        REQUIRE(is_screen_picture(folder / name));
        REQUIRE(write_screen_picture(folder / name, shades(8, 8, 3).view()));
        return file_bytes(folder / name)[0];
    };
    CHECK(starts("a.png") == 0x89);
    CHECK(starts("a.PNG") == 0x89);
    CHECK(starts("a.jpg") == 0xff);
    CHECK(starts("a.JPEG") == 0xff);
    CHECK(!is_screen_picture("a.exr"));
    CHECK(!is_screen_picture("png"));
    CHECK(holds_opacity("a.png"));
    CHECK(!holds_opacity("a.jpeg"));
}
