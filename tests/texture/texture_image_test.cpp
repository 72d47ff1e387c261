#include "io/picture/texture_image.h"

#include "io/jpeg_sample.h"
#include "test.h"

#include <png.h>
#include <webp/encode.h>

#include <cstdio>
#include <cstring>

using namespace domelight;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Texels that differ in every channel.
Bytes texels(int width, int height, bool alpha = true) {
    Bytes rgba;
    for (int i = 0; i < width * height; ++i)
        for (const int c : {i * 7, i * 13 + 50, 255 - i, alpha ? i * 31 : 255}) rgba.push_back(std::uint8_t(c));
    return rgba;
}

Bytes png(const Bytes& pixels, int width, int height, std::uint32_t format) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width), image.height = png_uint_32(height), image.format = format;
    png_alloc_size_t size = 0;
    REQUIRE(png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr));
    Bytes out(size);
    REQUIRE(png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr));
    out.resize(size);
    return out;
}

Bytes webp(const Bytes& rgba, int width, int height) {
    std::uint8_t* packed = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, width * 4, &packed);
    Bytes out(packed, packed + size);
    WebPFree(packed);
    return out;
}

Bytes jpeg(int width, int height, const std::uint8_t rgb[3]) {
    Bytes rows;
    for (int i = 0; i < width * height; ++i) rows.insert(rows.end(), rgb, rgb + 3);
    return test::encode_jpeg({width, height}, std::move(rows));
}

}  // namespace

TEST_CASE("texture image: PNG and WebP give back the texels, alpha included") {
    const Bytes rgba = texels(13, 7);
    for (const Bytes& file : {png(rgba, 13, 7, PNG_FORMAT_RGBA), webp(rgba, 13, 7)}) {
        const auto size = texture_image_size(file);
        REQUIRE(size);
        CHECK((size->width == 13 && size->height == 7));
        const auto image = decode_texture_image(file);
        REQUIRE_MESSAGE(image, image.error().format());
        CHECK((image->width == 13 && image->height == 7));
        // Invisible texels may lose their colour in WebP.
        for (std::size_t i = 0; i < rgba.size(); i += 4)
            CHECK((image->rgba[i + 3] == rgba[i + 3] &&
                   (rgba[i + 3] == 0 || std::memcmp(&image->rgba[i], &rgba[i], 3) == 0)));
    }
}

TEST_CASE("texture image: grey, 16-bit and JPEG images become RGBA") {
    const auto grey = decode_texture_image(png({0, 100, 255, 7}, 2, 2, PNG_FORMAT_GRAY));
    REQUIRE(grey);
    CHECK(grey->rgba == Bytes{0, 0, 0, 255, 100, 100, 100, 255, 255, 255, 255, 255, 7, 7, 7, 255});

    const std::uint8_t rgb[3] = {200, 100, 50};
    const auto photo = decode_texture_image(jpeg(17, 9, rgb));
    REQUIRE_MESSAGE(photo, photo.error().format());
    CHECK((photo->width == 17 && photo->height == 9));
    for (std::size_t i = 0; i < photo->rgba.size(); i += 4) {
        for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(int(photo->rgba[i + c]) - rgb[c]) <= 2);  // through YCbCr
        CHECK(photo->rgba[i + 3] == 255);
    }
}

TEST_CASE("texture image: truncated and lying files are errors") {
    const std::uint8_t rgb[3] = {1, 2, 3};
    const Bytes rgba = texels(64, 64);
    for (const Bytes& file : {png(rgba, 64, 64, PNG_FORMAT_RGBA), webp(rgba, 64, 64), jpeg(64, 64, rgb)})
        for (std::size_t keep = 0; keep + 16 < file.size(); keep += 1 + keep / 3) {
            INFO(keep << " of " << file.size());
            CHECK(!decode_texture_image(std::span(file).first(keep)));
        }
    Bytes large = png(rgba, 64, 64, PNG_FORMAT_RGBA);
    large[17] = 0xff, large[21] = 0xff;  // 16 million texels a side
    CHECK(!texture_image_size(large));
    large[16] = large[17] = large[20] = large[21] = 0;
    large[18] = large[22] = 0xff;  // 65 thousand
    CHECK(!texture_image_size(large));
}
