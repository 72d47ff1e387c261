#include "io/jpeg_sample.h"
#include "io/picture/screen_colour.h"
#include "io/reader_samples.h"
#include "test.h"

#include <png.h>

#include <cmath>
#include <cstdio>
#include <cstring>

using namespace domelight;
using namespace domelight::test;

namespace {

struct PngShape {
    int width = 16, height = 8, depth = 8, color_type = PNG_COLOR_TYPE_RGB;
    bool interlaced = false;
};

std::uint16_t code(int x, int y, int c, int depth) {
    const int v = (x * 15 + y * 31 + c * 67) % 256;
    return std::uint16_t(depth == 16 ? v * 257 + (x + c) % 3 : v);
}

Bytes make_png(const PngShape& shape) {
    Bytes out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &out,
        [](png_structp p, png_bytep data, std::size_t n) {
            static_cast<Bytes*>(png_get_io_ptr(p))
                ->insert(static_cast<Bytes*>(png_get_io_ptr(p))->end(), data, data + n);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, png_uint_32(shape.width), png_uint_32(shape.height), shape.depth, shape.color_type,
                 shape.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (shape.color_type == PNG_COLOR_TYPE_PALETTE) {
        png_color palette[256];
        for (int i = 0; i < 256; ++i) palette[i] = {png_byte(i), png_byte(255 - i), png_byte(i / 2)};
        png_set_PLTE(png, info, palette, 256);
    }
    png_write_info(png, info);
    const int channels = png_get_channels(png, info), size = shape.depth / 8;
    std::vector<Bytes> rows;
    std::vector<png_bytep> starts;
    for (int y = 0; y < shape.height; ++y) {
        Bytes row;
        for (int x = 0; x < shape.width; ++x)
            for (int c = 0; c < channels; ++c) {
                const std::uint16_t v = code(x, y, c, shape.depth);
                if (size == 2) row.push_back(std::uint8_t(v >> 8));
                row.push_back(std::uint8_t(v));
            }
        rows.push_back(std::move(row));
    }
    for (Bytes& row : rows) starts.push_back(row.data());
    png_write_image(png, starts.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return out;
}

Bytes make_jpeg(int width, int height, int components, bool progressive) {
    Bytes rows;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < components; ++c) rows.push_back(std::uint8_t(40 + 2 * x + 3 * y + 20 * c));
    return encode_jpeg({width, height, components, 98, progressive}, std::move(rows));
}

}  // namespace

TEST_CASE("screen curves: sRGB, gamma 2.2 and linear at known points") {
    const auto srgb = screen_curve(Decode::srgb, 256), gamma = screen_curve(Decode::gamma22, 256),
               linear = screen_curve(Decode::linear, 256);
    for (const auto* curve : {&srgb, &gamma, &linear}) {
        CHECK(curve->front() == 0);
        CHECK(curve->back() == 1);
    }
    CHECK(std::abs(srgb[128] - 0.2158605) < 1e-6);  // the usual table's value
    CHECK(std::abs(srgb[10] - 10 / 255.0 / 12.92) < 1e-7);
    CHECK(std::abs(srgb[50] - 0.0318960) < 1e-6);
    CHECK(std::abs(gamma[128] - std::pow(128 / 255.0, 2.2)) < 1e-7);
    CHECK(linear[51] == 0.2f);
    CHECK(screen_curve(Decode::automatic, 256) == srgb);
}

TEST_CASE("png reader: every kind of colour, 8 and 16 bits, interlaced or not") {
    for (const bool interlaced : {false, true})
        for (const int depth : {8, 16})
            for (const int type : {PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA, PNG_COLOR_TYPE_GRAY,
                                   PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_PALETTE}) {
                if (type == PNG_COLOR_TYPE_PALETTE && depth == 16) continue;
                const PngShape shape{.depth = depth, .color_type = type, .interlaced = interlaced};
                const auto reader = open_bytes(make_png(shape), {.decode = Decode::linear});
                REQUIRE_MESSAGE(reader, reader.error().format());
                const bool alpha = type & PNG_COLOR_MASK_ALPHA;
                CHECK((*reader)->facts().warnings.size() == (alpha ? 2 : 1));
                CHECK((*reader)->facts().warnings[0].find("not HDR") != std::string::npos);
                const auto image = read_all(**reader);
                REQUIRE_MESSAGE(image, image.error().format());
                for (int y = 0; y < shape.height; ++y)
                    for (int x = 0; x < shape.width; ++x)
                        for (int c = 0; c < 3; ++c) {
                            const int v = code(
                                x, y, type & PNG_COLOR_MASK_COLOR && type != PNG_COLOR_TYPE_PALETTE ? c : 0, depth);
                            const int palette[3] = {v, 255 - v, v / 2};
                            const int expected = type == PNG_COLOR_TYPE_PALETTE ? palette[c] : v;
                            CHECK(image->at(x, y)[c] == float(expected / (depth == 16 ? 65535.0 : 255.0)));
                        }
            }
}

TEST_CASE("png reader: sRGB is the default, and says so") {
    const auto reader = open_bytes(make_png({}));
    REQUIRE(reader);
    CHECK((*reader)->facts().warnings.size() == 2);
    CHECK(read_all(**reader)->at(3, 2)[1] == screen_curve(Decode::srgb, 256)[code(3, 2, 1, 8)]);
}

TEST_CASE("png reader: cut and lying files give an error") {
    const Bytes png = make_png({.width = 64, .height = 32});
    for (std::size_t length = 8; length < png.size(); length += 13)
        CHECK_FALSE(read_bytes(Bytes(png.begin(), png.begin() + std::ptrdiff_t(length))));
    Bytes changed = png;
    changed[60] ^= 1;  // a check sum fails
    CHECK_FALSE(read_bytes(changed));
    const Bytes large = make_png({.width = 64, .height = 32, .interlaced = true});
    CHECK(read_bytes(large, {.max_bytes = 64 * 32 * 3}));
    CHECK_FALSE(read_bytes(large, {.max_bytes = 64 * 32 * 3 - 1}));
}

TEST_CASE("jpeg reader: baseline, progressive and grey") {
    for (const bool progressive : {false, true})
        for (const int components : {1, 3}) {
            const Bytes jpeg = make_jpeg(40, 20, components, progressive);
            const auto reader = open_bytes(jpeg, {.decode = Decode::linear});
            REQUIRE_MESSAGE(reader, reader.error().format());
            CHECK((*reader)->facts().format == "JPEG");
            const auto image = read_all(**reader);
            REQUIRE_MESSAGE(image, image.error().format());
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 40; ++x)
                    for (int c = 0; c < 3; ++c)
                        CHECK(std::abs(image->at(x, y)[c] * 255 -
                                       (40 + 2 * x + 3 * y + (components == 3 ? 20 * c : 0))) < 6);  // quality 98
        }
}

TEST_CASE("jpeg reader: cut files, printing inks and the memory limit give an error") {
    const Bytes jpeg = make_jpeg(128, 64, 3, false);
    for (std::size_t length = 3; length + 2 < jpeg.size(); length += 29)
        CHECK_FALSE(read_bytes(Bytes(jpeg.begin(), jpeg.begin() + std::ptrdiff_t(length))));
    const auto inks = read_bytes(make_jpeg(16, 8, 4, false));
    REQUIRE_FALSE(inks);
    CHECK(inks.error().what.find("CMYK") != std::string::npos);
    const Bytes progressive = make_jpeg(128, 64, 3, true);
    CHECK(read_bytes(progressive));
    CHECK_FALSE(read_bytes(progressive, {.max_bytes = 128 * 64 * 3}));
}
