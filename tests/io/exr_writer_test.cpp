#include "domelight/io/write_image.h"
#include "domelight/projection/projection.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/texel/half.h"

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <limits>

using namespace domelight;
using namespace domelight::test;

namespace {

const std::vector<std::string> k_compressions{"none",  "rle", "zips", "zip",  "piz",
                                              "pxr24", "b44", "b44a", "dwaa", "dwab"};

/// Smooth values, so that lossy compressions stay close.
ImageF sample_image(int width, int height, int channels) {
    ImageF image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] = 1.5f + std::sin(0.05f * float(x) + float(c)) * std::cos(0.07f * float(y));
    return image;
}

ImageF read_exr(const std::filesystem::path& file, const std::vector<const char*>& channels) {
    Imf::InputFile in(file.c_str());
    const Imath::Box2i window = in.header().dataWindow();
    ImageF image(window.max.x + 1, window.max.y + 1, int(channels.size()));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c)
        frame.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.pixels().data() + c),
                                             4 * channels.size(), 4 * channels.size() * std::size_t(image.width())));
    in.setFrameBuffer(frame);
    in.readPixels(0, window.max.y);
    return image;
}

}  // namespace

TEST_CASE("write_exr: lossless compressions keep every bit, lossy ones stay close") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    const ImageF image = sample_image(130, 150, 3);
    for (const std::string& compression : k_compressions)
        for (bool half : {true, false}) {
            CAPTURE(compression);
            REQUIRE(write_exr(file, image, {.half = half, .compression = compression}));
            const ImageF back = read_exr(file, {"R", "G", "B"});
            const bool lossy =
                compression.starts_with("b44") || compression.starts_with("dwa") || (compression == "pxr24" && !half);
            for (std::size_t i = 0; i < image.pixels().size(); ++i) {
                const float v = image.pixels()[i], stored = half ? float_from_half(half_from_float(v)) : v;
                if (lossy)
                    REQUIRE(std::abs(back.pixels()[i] - v) < 0.06f);
                else
                    REQUIRE(back.pixels()[i] == stored);
            }
        }
}

TEST_CASE("write_exr: channels, attributes, chromaticities") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    const std::vector<std::vector<const char*>> names{{"Y"}, {"R", "G"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    for (int channels = 1; channels <= 4; ++channels) {
        const ImageF image = sample_image(9, 5, channels);
        REQUIRE(write_exr(file, image,
                          {.half = false, .envmap = "latlong", .attributes = {{"domelight:roughness", "0.25"}}}));
        const ImageF back = read_exr(file, names[std::size_t(channels - 1)]);
        CHECK(std::equal(back.pixels().begin(), back.pixels().end(), image.pixels().begin()));
        Imf::InputFile in(file.c_str());
        int count = 0;
        for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) ++count;
        CHECK(count == channels);
        CHECK(in.header().typedAttribute<Imf::StringAttribute>("domelight:roughness").value() == "0.25");
        CHECK(Imf::envmap(in.header()) == Imf::ENVMAP_LATLONG);
        CHECK(Imf::chromaticities(in.header()).red.x == doctest::Approx(0.64));
    }
}

TEST_CASE("write_exr: half is clipped at 65504, float is not") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    ImageF image(4, 1, 3, 1.0f);
    image.pixels()[0] = 1e6f;
    image.pixels()[1] = -1e6f;
    REQUIRE(write_exr(file, image, {.half = true}));
    CHECK(read_exr(file, {"R", "G", "B"}).pixels()[0] == 65504);
    CHECK(read_exr(file, {"R", "G", "B"}).pixels()[1] == -65504);
    REQUIRE(write_exr(file, image, {.half = false}));
    CHECK(read_exr(file, {"R", "G", "B"}).pixels()[0] == 1e6f);
}

TEST_CASE("write_exr: channels are half where that clips nothing, else float, unless they are asked for") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    const auto channel_type = [&] { return Imf::InputFile(file.c_str()).header().channels().begin().channel().type; };
    ImageF image(4, 2, 3, 65504.0f);
    REQUIRE(write_exr(file, image));
    CHECK(channel_type() == Imf::HALF);
    for (const float value : {65505.0f, -1e6f, std::numeric_limits<float>::infinity()}) {
        image.at(3, 1)[2] = value;
        CHECK_FALSE(fits_half(image));
        REQUIRE(write_exr(file, image));
        CHECK(channel_type() == Imf::FLOAT);
        CHECK(read_exr(file, {"R", "G", "B"}).at(3, 1)[2] == value);
    }
    ImageRowSource rows(image), same_rows(image);
    CHECK_FALSE(*fits_half(rows));
    REQUIRE(write_exr(file, same_rows));
    CHECK(channel_type() == Imf::FLOAT);
}

TEST_CASE("write_exr: a cube lies as OpenEXR's own directions say") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    const int size = 8;
    Cubemap cube(size);
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3d d = normalize(cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size}));
                float* texel = cube.face(f).at(x, y);
                texel[0] = float(d.x), texel[1] = float(d.y), texel[2] = float(d.z);
            }
    REQUIRE(write_exr(file, cube.strip(), {.half = false, .envmap = "cube"}));
    const ImageF back = read_exr(file, {"R", "G", "B"});
    const Imath::Box2i window({0, 0}, {size - 1, 6 * size - 1});
    for (int f = 0; f < 6; ++f)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                // Positions in a face differ from those of pixels, because OpenEXR turns each face differently. Its
                // outer texels lie on the edges of the faces, ours half a texel inside.
                const Imath::V2f position(static_cast<float>(x), static_cast<float>(y));
                const Imath::V2f pixel = Imf::CubeMap::pixelPosition(Imf::CubeMapFace(f), window, position);
                const Imath::V3f d = Imf::CubeMap::direction(Imf::CubeMapFace(f), window, position).normalized();
                const float* texel = back.at(int(std::lround(pixel.x)), int(std::lround(pixel.y)));
                REQUIRE(d.x * texel[0] + d.y * texel[1] + d.z * texel[2] > 0.98f);
            }
    CHECK(!write_exr(file, ImageF(8, 8, 3), {.envmap = "cube"}));
}

TEST_CASE("write_exr: the same bytes on any number of threads, from a view and from rows") {
    const TemporaryFolder folder;
    const ImageF image = sample_image(100, 200, 3);
    for (const std::string& compression : k_compressions) {
        CAPTURE(compression);
        REQUIRE(write_exr(folder / "1.exr", image, {.half = true, .compression = compression, .threads = 1}));
        const auto expected = file_bytes(folder / "1.exr");
        REQUIRE(write_exr(folder / "4.exr", image, {.half = true, .compression = compression, .threads = 4}));
        CHECK(file_bytes(folder / "4.exr") == expected);
        ImageRowSource rows(image.view());
        REQUIRE(write_exr(folder / "r.exr", rows, {.half = true, .compression = compression}));
        CHECK(file_bytes(folder / "r.exr") == expected);
    }
}

TEST_CASE("write_exr: wrong options are one error, and nothing is left behind") {
    const TemporaryFolder folder;
    const auto file = folder / "a.exr";
    const ImageF image = sample_image(8, 8, 3);
    const auto unknown = write_exr(file, image, {.compression = "lzma"});
    REQUIRE(!unknown);
    CHECK(unknown.error().hint.find("dwab") != std::string::npos);
    CHECK(!write_exr(file, image, {.envmap = "sphere"}));
    CHECK(!write_exr(file, image, {.attributes = {{"channels", "clash"}}}));
    CHECK(std::filesystem::is_empty(folder.path()));
}
