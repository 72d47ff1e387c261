#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "io/reader_samples.h"
#include "test.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfPreviewImage.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <functional>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A smooth picture (the lossy methods keep it within a few percent) without symmetry.
float sample(int x, int y, int c) {
    return float(1 + 0.5 * std::sin(0.11 * x + c) + 0.4 * std::cos(0.17 * y - c) + 0.01 * c);
}

ImageF sample_image(int width, int height) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = sample(x, y, c);
    return image;
}

/// Channels of one type in memory, and the frame buffer with which OpenEXR accesses them at `origin`.
struct Channels {
    Imf::PixelType type;
    std::vector<std::string> names;
    int width, height;
    std::vector<std::vector<char>> data;

    Channels(Imf::PixelType type_, std::vector<std::string> names_, int width_, int height_,
             const std::function<float(int, int, int)>& value = sample)
        : type(type_), names(std::move(names_)), width(width_), height(height_) {
        const std::size_t size = type == Imf::HALF ? 2 : 4;
        for (std::size_t c = 0; c < names.size(); ++c) {
            data.emplace_back(size * std::size_t(width) * std::size_t(height));
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    char* at = &data[c][size * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
                    const float v = value(x, y, int(c));
                    if (type == Imf::HALF) *reinterpret_cast<half*>(at) = half(v);
                    if (type == Imf::FLOAT) *reinterpret_cast<float*>(at) = v;
                    if (type == Imf::UINT) *reinterpret_cast<std::uint32_t*>(at) = std::uint32_t(v);
                }
        }
    }
    void add_to(Imf::Header& header) const {
        for (const std::string& name : names) header.channels().insert(name, Imf::Channel(type));
    }
    Imf::FrameBuffer frame(Imath::V2i origin) {
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < names.size(); ++c)
            buffer.insert(names[c], Imf::Slice::Make(type, data[c].data(), origin, width, height));
        return buffer;
    }
};

const std::vector<std::string> k_rgb{"R", "G", "B"};

void write_scanlines(const std::filesystem::path& file, Imf::Header header, Channels channels) {
    channels.add_to(header);
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(channels.frame(header.dataWindow().min));
    out.writePixels(channels.height);
}

double largest_difference(const ImageF& a, const ImageF& b) {
    REQUIRE(a.width() == b.width());
    REQUIRE(a.height() == b.height());
    double largest = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        largest = std::max(largest, double(std::abs(a.pixels()[i] - b.pixels()[i])));
    return largest;
}

}  // namespace

TEST_CASE("exr reader: every compression and pixel type, on one thread and several") {
    TemporaryFolder folder;
    const int width = 70, height = 300;  // more than one block of every method
    const ImageF expected = sample_image(width, height);
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
        for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
            Imf::Header header(width, height);
            header.compression() = Imf::Compression(compression);
            write_scanlines(folder / "a.exr", header, Channels(type, k_rgb, width, height));
            // Half: a step of 2^-10 below 2. B44 and DWA are lossy: a few percent of 2; PXR24 rounds floats to 24 bits.
            const bool lossy = compression >= Imf::B44_COMPRESSION;
            const double tolerance = lossy                                   ? 0.05
                                     : type == Imf::HALF                     ? 0x1p-11
                                     : compression == Imf::PXR24_COMPRESSION ? 0x1p-16
                                                                             : 0;
            std::optional<ImageF> first;
            for (const int threads : {1, 3}) {
                const auto image = read_bytes(load(folder / "a.exr"), {.threads = threads});
                REQUIRE_MESSAGE(image, image.error().format());
                CHECK(largest_difference(*image, expected) <= tolerance);
                if (first) CHECK(same_pixels(*image, *first));
                first = *image;
            }
        }
}

TEST_CASE("exr reader: whole numbers, one luminance, layers and missing channels") {
    TemporaryFolder folder;
    const auto whole = [](int x, int y, int c) { return float(100 * x + 10 * y + c); };
    write_scanlines(folder / "uint.exr", Imf::Header(8, 4), Channels(Imf::UINT, k_rgb, 8, 4, whole));
    const auto image = read_bytes(load(folder / "uint.exr"));
    REQUIRE(image);
    CHECK(image->at(7, 3)[2] == 732);

    write_scanlines(folder / "y.exr", Imf::Header(8, 4), Channels(Imf::FLOAT, {"Y"}, 8, 4));
    const auto grey = read_bytes(load(folder / "y.exr"));
    REQUIRE(grey);
    for (int c = 0; c < 3; ++c) CHECK(grey->at(5, 2)[c] == sample(5, 2, 0));

    write_scanlines(folder / "layer.exr", Imf::Header(8, 4),
                    Channels(Imf::FLOAT, {"Z", "beauty.B", "beauty.G", "beauty.R"}, 8, 4));
    const auto layer = read_bytes(load(folder / "layer.exr"));
    REQUIRE(layer);
    for (int c = 0; c < 3; ++c) CHECK(layer->at(5, 2)[c] == sample(5, 2, 3 - c));

    write_scanlines(folder / "rg.exr", Imf::Header(8, 4), Channels(Imf::FLOAT, {"R", "G"}, 8, 4));
    const auto two = open_bytes(load(folder / "rg.exr"));
    REQUIRE(two);
    CHECK((*two)->facts().warnings.size() == 1);
    CHECK(read_all(**two)->at(5, 2)[2] == 0);

    write_scanlines(folder / "z.exr", Imf::Header(8, 4), Channels(Imf::FLOAT, {"Z", "id"}, 8, 4));
    const auto none = open_bytes(load(folder / "z.exr"));
    REQUIRE_FALSE(none);
    CHECK(none.error().what.find("Z") != std::string::npos);
}

TEST_CASE("exr reader: tiles, mip maps and rip maps give their finest level") {
    TemporaryFolder folder;
    const int width = 100, height = 50;
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        Channels channels(Imf::FLOAT, k_rgb, width, height);
        Imf::Header header(width, height);
        channels.add_to(header);
        header.setTileDescription(Imf::TileDescription(32, 16, mode));
        {
            Imf::TiledOutputFile out((folder / "t.exr").c_str(), header);
            out.setFrameBuffer(channels.frame({0, 0}));
            for (int ly = 0; ly < out.numYLevels(); ++ly)
                for (int lx = 0; lx < out.numXLevels(); ++lx)
                    if (out.isValidLevel(lx, ly))
                        out.writeTiles(0, out.numXTiles(lx) - 1, 0, out.numYTiles(ly) - 1, lx, ly);
        }
        const auto image = read_bytes(load(folder / "t.exr"));
        REQUIRE_MESSAGE(image, image.error().format());
        CHECK(same_pixels(*image, sample_image(width, height)));
    }
}

TEST_CASE("exr reader: of several parts the first with colour is read, and deep ones are refused") {
    TemporaryFolder folder;
    Channels depth(Imf::FLOAT, {"Z"}, 16, 8), colour(Imf::FLOAT, k_rgb, 16, 8);
    std::vector<Imf::Header> headers;
    for (const Channels* part : {&depth, &colour}) {
        Imf::Header header(16, 8);
        header.setType(Imf::SCANLINEIMAGE);
        header.setName(part->names[0]);
        part->add_to(header);
        headers.push_back(header);
    }
    {
        Imf::MultiPartOutputFile out((folder / "m.exr").c_str(), headers.data(), 2);
        for (int p = 0; p < 2; ++p) {
            Imf::OutputPart part(out, p);
            part.setFrameBuffer((p ? colour : depth).frame({0, 0}));
            part.writePixels(8);
        }
    }
    const auto image = read_bytes(load(folder / "m.exr"));
    REQUIRE_MESSAGE(image, image.error().format());
    CHECK(same_pixels(*image, sample_image(16, 8)));

    Imf::Header deep(2, 1);
    deep.setType(Imf::DEEPSCANLINE);
    deep.setName("deep");
    deep.compression() = Imf::ZIPS_COMPRESSION;
    for (const std::string& name : k_rgb) deep.channels().insert(name, Imf::Channel(Imf::FLOAT));
    {
        Imf::MultiPartOutputFile out((folder / "d.exr").c_str(), &deep, 1);
        Imf::DeepScanLineOutputPart part(out, 0);
        unsigned counts[2] = {0, 0};
        float* pointers[2] = {nullptr, nullptr};
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), sizeof(unsigned), 2 * sizeof(unsigned)));
        for (const std::string& name : k_rgb)
            buffer.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), sizeof(float*),
                                               2 * sizeof(float*), sizeof(float)));
        part.setFrameBuffer(buffer);
        part.writePixels(1);
    }
    const auto refused = read_bytes(load(folder / "d.exr"));
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("deep") != std::string::npos);
}

TEST_CASE("exr reader: the picture is the display window; texels outside the data window are black") {
    TemporaryFolder folder;
    const Imath::Box2i display({10, 20}, {29, 29});
    // A data window inside the display window, one that extends beyond each side, and one that covers it.
    for (const Imath::Box2i& data :
         {Imath::Box2i({12, 22}, {25, 27}), Imath::Box2i({5, 15}, {19, 24}), Imath::Box2i({0, 0}, {40, 40})}) {
        const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
        write_scanlines(folder / "w.exr", Imf::Header(display, data), Channels(Imf::FLOAT, k_rgb, width, height));
        for (const int rows : {1, 3, 10}) {
            const auto reader = open_bytes(load(folder / "w.exr"));
            REQUIRE_MESSAGE(reader, reader.error().format());
            const auto image = read_all(**reader, rows);
            REQUIRE(image);
            REQUIRE(image->width() == 20);
            REQUIRE(image->height() == 10);
            for (int y = 0; y < 10; ++y)
                for (int x = 0; x < 20; ++x) {
                    const int dx = x + 10 - data.min.x, dy = y + 20 - data.min.y;
                    const bool inside = dx >= 0 && dy >= 0 && dx < width && dy < height;
                    for (int c = 0; c < 3; ++c) CHECK(image->at(x, y)[c] == (inside ? sample(dx, dy, c) : 0));
                }
        }
    }
    write_scanlines(folder / "o.exr", Imf::Header(display, Imath::Box2i({100, 100}, {103, 103})),
                    Channels(Imf::FLOAT, k_rgb, 4, 4));
    CHECK_FALSE(read_bytes(load(folder / "o.exr")));

    // An environment is its data window.
    Imf::Header header(display, Imath::Box2i({0, 0}, {15, 7}));
    Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
    write_scanlines(folder / "e.exr", header, Channels(Imf::FLOAT, k_rgb, 16, 8));
    const auto environment = open_bytes(load(folder / "e.exr"));
    REQUIRE(environment);
    CHECK((*environment)->facts().envmap == ImageFacts::Envmap::latlong);
    CHECK(same_pixels(*read_all(**environment), sample_image(16, 8)));
}

TEST_CASE("exr reader: a header alone does not ask for gigabytes of black round its texels") {
    TemporaryFolder folder;
    const auto opened = [&](int width, int height, const Imath::Box2i& data, std::int64_t max_bytes) {
        write_scanlines(folder / "w.exr", Imf::Header(Imath::Box2i({0, 0}, {width - 1, height - 1}), data),
                        Channels(Imf::FLOAT, k_rgb, data.max.x - data.min.x + 1, data.max.y - data.min.y + 1));
        ReaderOptions options;
        options.max_bytes = max_bytes;
        return open_exr_reader(FileBytes::from_memory(load(folder / "w.exr")), options);
    };
    const Imath::Box2i small({0, 0}, {3, 1});
    const auto huge = opened(65536, 32768, small, std::int64_t(1) << 30);
    REQUIRE_FALSE(huge);
    CHECK(huge.error().what.find("the display window has 2147483648 texels, but the data window only 8") == 0);
    CHECK(!huge.error().hint.empty());
    CHECK(opened(8192, 4096, small, std::int64_t(1) << 30));
    CHECK_FALSE(opened(12000, 6000, small, std::int64_t(1) << 30));
    // An image of any size is read if the file holds a good part of it.
    CHECK_FALSE(opened(320, 160, small, 1 << 18));
    const auto half = opened(320, 160, Imath::Box2i({0, 0}, {319, 79}), 1 << 18);
    CHECK_MESSAGE(half, half.error().format());
    CHECK_FALSE(opened(320, 160, Imath::Box2i({-319, 0}, {0, 79}), 1 << 18));
}

TEST_CASE("exr reader: luminance and chroma become colour") {
    TemporaryFolder folder;
    const int width = 64, height = 32;
    const auto gentle = [](int x, int y, int c) {
        return float(1 + 0.2 * std::sin(0.03 * x + c) + 0.1 * std::cos(0.04 * y));
    };
    std::vector<Imf::Rgba> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) pixels.emplace_back(gentle(x, y, 0), gentle(x, y, 1), gentle(x, y, 2));
    {
        Imf::RgbaOutputFile out((folder / "yc.exr").c_str(), width, height, Imf::WRITE_YC);
        out.setFrameBuffer(pixels.data(), 1, std::size_t(width));
        out.writePixels(height);
    }
    for (const int rows : {1, 7, 32}) {
        const auto reader = open_bytes(load(folder / "yc.exr"));
        REQUIRE_MESSAGE(reader, reader.error().format());
        const auto image = read_all(**reader, rows);
        REQUIRE_MESSAGE(image, image.error().format());
        // Chroma is stored at half the resolution, which a picture this smooth hardly shows; luminance in steps of 2^-7
        // at worst.
        double largest = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, double(std::abs(image->at(x, y)[c] - gentle(x, y, c))));
        CHECK(largest < 0x1p-7);
    }
}

TEST_CASE("exr reader: chromaticities become Rec. 709") {
    TemporaryFolder folder;
    Imf::Header header(2, 1);
    // CIE XYZ itself, with D65 as white: the matrix is the one from XYZ, up to the white's luminance.
    Imf::addChromaticities(header, {{1, 0}, {0, 1}, {0, 0}, {0.3127f, 0.3290f}});
    write_scanlines(folder / "xyz.exr", header, Channels(Imf::FLOAT, k_rgb, 2, 1, [](int, int, int) { return 1.0f; }));
    auto environment = open_environment({folder / "xyz.exr"});
    REQUIRE_MESSAGE(environment, environment.error().format());
    const auto image = read_latlong(**environment->rows());
    REQUIRE(image);
    for (const float v : image->pixels()) CHECK(std::abs(v - 1) < 1e-5);
    CHECK(environment->report().warnings.size() == 1);

    // XYZ itself must say that equal energy is white. Its grey is D65 all the same.
    Imf::Header xyz(2, 1);
    Imf::addChromaticities(xyz, {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0f, 1 / 3.0f}});
    write_scanlines(folder / "e.exr", xyz, Channels(Imf::FLOAT, k_rgb, 2, 1, [](int, int, int c) {
                        return c == 0 ? 0.47523f : c == 1 ? 0.5f : 0.54453f;
                    }));
    auto grey = open_environment({folder / "e.exr"});
    REQUIRE(grey);
    const auto half = read_latlong(**grey->rows());
    REQUIRE(half);
    for (const float v : half->pixels()) CHECK(std::abs(v - 0.5) < 1e-4);

    Imf::Header plain(2, 1);
    Imf::addChromaticities(plain, {});
    write_scanlines(folder / "709.exr", plain, Channels(Imf::FLOAT, k_rgb, 2, 1));
    const auto same = open_bytes(load(folder / "709.exr"));
    REQUIRE(same);
    CHECK(!(*same)->facts().to_rec709);
}

TEST_CASE("exr reader: other attributes, however odd, do no harm") {
    TemporaryFolder folder;
    Imf::Header header(16, 8);
    header.setPreviewImage(Imf::PreviewImage(4, 4));
    Imf::addOwner(header, "somebody");
    Imf::addWrapmodes(header, "periodic");
    write_scanlines(folder / "a.exr", header, Channels(Imf::FLOAT, k_rgb, 16, 8));
    Bytes file = load(folder / "a.exr");
    CHECK(read_bytes(file));
    // A preview of 65535 x 65535 would be 17 GB.
    const std::string name("preview\0preview\0", 16);
    auto at = std::search(file.begin(), file.end(), name.begin(), name.end());
    REQUIRE(at != file.end());
    at += 16 + 4;
    std::fill(at, at + 2, std::uint8_t(255));
    std::fill(at + 4, at + 6, std::uint8_t(255));
    CHECK(read_bytes(file));
}

TEST_CASE("exr reader: damaged files give one clear error") {
    TemporaryFolder folder;
    Imf::Header header(64, 32);
    header.compression() = Imf::ZIPS_COMPRESSION;
    write_scanlines(folder / "a.exr", header, Channels(Imf::FLOAT, k_rgb, 64, 32));
    const Bytes file = load(folder / "a.exr");
    // A file cut off anywhere is not read as a picture.
    for (std::size_t length = 4; length < file.size(); length += length < 700 ? 1 : 97) {
        const auto cut = read_bytes(Bytes(file.begin(), file.begin() + std::ptrdiff_t(length)));
        CHECK_FALSE(cut);
    }
    const auto with_window = [&](std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
        Bytes changed = file;
        const std::string name("dataWindow\0box2i\0", 17);
        const auto at = std::search(changed.begin(), changed.end(), name.begin(), name.end());
        REQUIRE(at != changed.end());
        const std::int32_t box[4] = {x0, y0, x1, y1};
        std::memcpy(&*at + 17 + 4, box, sizeof box);
        const auto image = read_bytes(changed);
        REQUIRE_FALSE(image);
        return image.error().what;
    };
    CHECK(with_window(0, 0, -1, -1).find("no texels") != std::string::npos);
    CHECK(with_window(0, 0, 99999, 99999).find("longer than") != std::string::npos);
    CHECK(with_window(0, 0, 59999, 59999).find("ends too early") != std::string::npos);
    CHECK(with_window(-2147483647 - 1, 0, 2147483647, 3).find("longer than") != std::string::npos);
    // Blocks that take more memory than the limit to decode.
    const auto limited = read_bytes(file, {.max_bytes = 1000});
    REQUIRE_FALSE(limited);
    CHECK(limited.error().what.find("limit") != std::string::npos);
}
