#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"

#include "io/hdr/hdr_scanline_reader.h"
#include "io/reader_samples.h"
#include "test.h"
#include "texture/texel/rgbe_decode.h"

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

/// An image without any symmetry, with long runs in the upper half.
Rgbe sample_texel(int x, int y) {
    if (y < 4) return {200, 10, std::uint8_t(128 + y), 130};
    return {std::uint8_t(128 + (x * 7 + y) % 128), std::uint8_t((x * x + 3 * y) % 251), std::uint8_t((x + y * y) % 13),
            std::uint8_t(120 + (x + y) % 16)};
}

double value_of(std::uint8_t mantissa, std::uint8_t exponent) {
    return exponent ? std::ldexp(mantissa, exponent - 136) : 0;
}

ImageF expected_image(int width, int height) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Rgbe t = sample_texel(x, y);
            for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] = float(value_of(t[c], t[3]));
        }
    return image;
}

using Encode = Bytes (*)(const std::vector<Rgbe>&);

/// The image in the order that a resolution line such as "+X 20 -Y 10" states.
Bytes encode(int width, int height, bool columns, bool flip_x, bool flip_y, Encode scanline) {
    const std::string x = std::string(flip_x ? "-" : "+") + "X " + std::to_string(width);
    const std::string y = std::string(flip_y ? "+" : "-") + "Y " + std::to_string(height);
    Bytes file = hdr_header(columns ? x + " " + y : y + " " + x);
    for (int i = 0; i < (columns ? width : height); ++i) {
        std::vector<Rgbe> texels;
        for (int j = 0; j < (columns ? height : width); ++j) {
            const int px = columns ? i : j, py = columns ? j : i;
            texels.push_back(sample_texel(flip_x ? width - 1 - px : px, flip_y ? height - 1 - py : py));
        }
        file = joined(std::move(file), scanline(texels));
    }
    return file;
}

}  // namespace

TEST_CASE("hdr reader: every encoding in every orientation gives the same image") {
    // 270 columns: a repetition of more than 255 texels needs two counts in the old encoding.
    const int width = 270, height = 11;
    const ImageF expected = expected_image(width, height);
    for (const Encode scanline : {new_rle_scanline, flat_scanline, old_rle_scanline})
        for (int orientation = 0; orientation < 8; ++orientation) {
            const Bytes file = encode(width, height, orientation & 1, orientation & 2, orientation & 4, scanline);
            for (const int threads : {1, 3}) {
                const auto image = read_bytes(file, {.threads = threads});
                REQUIRE_MESSAGE(image, image.error().format());
                CHECK_MESSAGE(same_pixels(*image, expected), "orientation ", orientation);
            }
        }
}

TEST_CASE("hdr reader: narrow images, which cannot be run-length encoded anew, are read") {
    for (const int width : {1, 2, 7}) {
        const auto image = read_bytes(encode(width, 5, false, false, false, flat_scanline));
        REQUIRE(image);
        CHECK(same_pixels(*image, expected_image(width, 5)));
    }
}

TEST_CASE("hdr reader: RGBE is mantissa times 2^(e - 136), the same bits with and without SIMD") {
    for (const int width : {1, 3, 16, 61, 256}) {
        std::vector<std::uint8_t> planes(std::size_t(4 * width));
        for (int e = 0; e < 256; ++e) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c) planes[std::size_t(c * width + x)] = std::uint8_t(x * (c + 1) + e);
                planes[std::size_t(3 * width + x)] = std::uint8_t(e);
            }
            for (const float scale : {1.0f, 0.3f}) {
                std::vector<float> fast(std::size_t(3 * width)), plain(fast.size());
                rgbe_to_float(planes.data(), std::size_t(width), width, {scale, 1, scale}, fast.data());
                rgbe_to_float_scalar(planes.data(), std::size_t(width), width, {scale, 1, scale}, plain.data());
                CHECK(fast == plain);
                if (scale != 1 || e == 1) continue;  // e = 1 lies below float's normal range: read as 0
                for (int x = 0; x < width; ++x)
                    for (int c = 0; c < 3; ++c)
                        CHECK(double(plain[std::size_t(3 * x + c)]) ==
                              value_of(planes[std::size_t(c * width + x)], std::uint8_t(e)));
            }
        }
    }
}

TEST_CASE("hdr reader: EXPOSURE and COLORCORR are divided out, all of them") {
    Bytes file = hdr_header("-Y 1 +X 2", "EXPOSURE=2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4.0\nCOLORCORR= 1 2 0.5\n");
    file = joined(file, {128, 128, 128, 129, 64, 32, 16, 129});
    const auto reader = open_bytes(file);
    REQUIRE(reader);
    const auto image = read_all(**reader);
    REQUIRE(image);
    const std::vector<float> expected{1 / 8.0f, 1 / 16.0f, 1 / 4.0f, 0.5f / 8, 0.25f / 16, 0.125f / 4};
    CHECK(std::vector<float>(image->pixels().begin(), image->pixels().end()) == expected);
    CHECK((*reader)->facts().warnings.size() == 1);

    // Invalid values are reported and not used.
    const auto odd = open_bytes(joined(hdr_header("-Y 1 +X 1", "EXPOSURE=0\nCOLORCORR=1\n"), {128, 128, 128, 129}));
    REQUIRE(odd);
    CHECK((*odd)->facts().warnings.size() == 2);
    CHECK(*read_all(**odd)->at(0, 0) == 1);
}

TEST_CASE("hdr reader: PRIMARIES and xyze become Rec. 709") {
    TemporaryFolder folder;
    // XYZ of D65 white, Y = 128/256 2^(129 - 128): grey after conversion. Mantissas 121.7, 128, 139.4.
    Bytes texel{122, 128, 139, 129};
    save(folder / "xyz.hdr", joined(hdr_header("-Y 1 +X 2", "FORMAT=32-bit_rle_xyze\n"), joined(texel, texel)));
    auto xyz = open_environment({folder / "xyz.hdr"});
    REQUIRE(xyz);
    const auto grey = read_latlong(**xyz->rows());
    REQUIRE(grey);
    for (const float v : grey->pixels()) CHECK(std::abs(v - 1) < 0.02);  // eight bits of mantissa, times the matrix

    // Radiance's own primaries: another green and white. White stays white; pure green leaks into red.
    const std::string radiance = "PRIMARIES= 0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333\n";
    save(folder / "p.hdr", joined(hdr_header("-Y 1 +X 2", radiance), {128, 128, 128, 129, 0, 128, 0, 129}));
    auto primaries = open_environment({folder / "p.hdr"});
    REQUIRE(primaries);
    const auto converted = read_latlong(**primaries->rows());
    REQUIRE(converted);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(converted->at(0, 0)[c] - 1) < 1e-3);  // because 0.333 is rounded
    CHECK(converted->at(1, 0)[1] > 0.9);
    CHECK(std::abs(converted->at(1, 0)[1] - 1) > 1e-3);
    CHECK(primaries->report().warnings.size() == 1);

    // Eight zeros mean that the primaries are unknown.
    const auto zeros = open_bytes(joined(hdr_header("-Y 1 +X 1", "PRIMARIES=0 0 0 0 0 0 0 0\n"), {1, 2, 3, 129}));
    REQUIRE(zeros);
    CHECK(!(*zeros)->facts().to_rec709);
    CHECK((*zeros)->facts().warnings.empty());
}

TEST_CASE("hdr reader: XYZ as primaries of RGB are CIE XYZ, whose grey is D65") {
    const auto reader =
        open_bytes(joined(hdr_header("-Y 1 +X 1", "PRIMARIES=1 0 0 1 0 0 0.3333 0.3333\n"), {1, 2, 3, 129}));
    REQUIRE(reader);
    REQUIRE((*reader)->facts().to_rec709);
    const Vec3d grey = *(*reader)->facts().to_rec709 * Vec3d{0.95046, 1, 1.08906};
    CHECK(length(grey - Vec3d(1, 1, 1)) < 1e-4);
}

TEST_CASE("hdr reader: Radiance's own XYZE is photometric, with equal energy as grey") {
    // ra_xyze leaves 1 / 179 in EXPOSURE, so that the texels have the scale of the RGBE picture. 179 lm/W were put in.
    const auto file = joined(hdr_header("-Y 1 +X 1", "ra_xyze in.hdr\nEXPOSURE=5.586592e-03\nFORMAT=32-bit_rle_xyze\n"),
                             {128, 128, 128, 129});
    const auto reader = open_bytes(file);
    REQUIRE(reader);
    const auto image = read_all(**reader);
    REQUIRE(image);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(image->at(0, 0)[c] - 1) < 1e-6);
    const Vec3d grey = *(*reader)->facts().to_rec709 * Vec3d{1, 1, 1};
    CHECK(length(grey - Vec3d(1, 1, 1)) < 1e-9);
}

TEST_CASE("hdr reader: the same light as Radiance's RGBE and XYZE") {
    DOMELIGHT_DATA_FILE(rgbe, "reports/rad_rgbe.hdr");
    DOMELIGHT_DATA_FILE(xyze, "reports/rad_xyze.hdr");
    const auto mean = [](const std::filesystem::path& file) {
        const auto environment = open_environment({file}, {.projection = "angular"});
        REQUIRE(environment);
        Vec3d sum;
        const ProjectedImage& picture = *environment->picture();
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x) {
                const float* p = picture.pixels.at(x, y);
                sum += Vec3d(p[0], p[1], p[2]);
            }
        return sum;
    };
    const Vec3d a = mean(rgbe), b = mean(xyze);
    // Eight bits of mantissa, which the matrix mixes: each texel is off by up to 1 %, and the mean by 0.1 %.
    for (const double ratio : {b.x / a.x, b.y / a.y, b.z / a.z}) CHECK(std::abs(ratio - 1) < 2e-3);
}

TEST_CASE("hdr reader: GAMMA is undone, by sRGB's curve where it is ImageMagick's 1 / 2.2") {
    const auto read = [](const std::string& gamma, int threads) {
        return read_bytes(
            joined(hdr_header("-Y 1 +X 2", "GAMMA=" + gamma + "\nEXPOSURE=2\n"), {171, 128, 10, 128, 128, 0, 255, 130}),
            {.threads = threads});
    };
    for (const int threads : {1, 2}) {
        const auto srgb = read("0.45455", threads), power = read("0.5", threads), linear = read("1", threads);
        REQUIRE((srgb && power && linear));
        CHECK(std::abs(srgb->at(0, 0)[0] - 0.40374 / 2) < 1e-5);  // 171 / 256
        CHECK(std::abs(srgb->at(0, 0)[1] - 0.214041 / 2) < 1e-5);
        CHECK(std::abs(srgb->at(0, 0)[2] - 10 / 256.0 / 12.92 / 2) < 1e-6);
        CHECK(std::abs(power->at(1, 0)[0] - 4 / 2) < 1e-6);
        CHECK(power->at(1, 0)[1] == 0);
        CHECK(std::abs(linear->at(1, 0)[0] - 2 / 2) < 1e-6);
    }
    const auto odd = open_bytes(joined(hdr_header("-Y 1 +X 1", "GAMMA=2.2\n"), {128, 128, 128, 129}));
    REQUIRE(odd);
    CHECK((*odd)->facts().warnings.size() == 1);
    CHECK(*read_all(**odd)->at(0, 0) == 1);
}

TEST_CASE("hdr reader: damaged files give one clear error") {
    const auto fails_with = [](const Bytes& file, const std::string& part) {
        const auto image = read_bytes(file);
        REQUIRE_FALSE(image);
        CHECK_MESSAGE(image.error().what.find(part) != std::string::npos, image.error().what);
    };
    const Bytes row = new_rle_scanline(std::vector<Rgbe>(300, Rgbe{1, 2, 3, 4}));
    const Bytes two = joined(hdr_header("-Y 2 +X 300"), row);
    fails_with(joined(two, Bytes(row.begin(), row.end() - 3)), "file ends inside a scanline");
    fails_with(two, "file ends");
    fails_with(joined(two, Bytes{2, 2, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}), "not as long as the header says");
    Bytes overrun = row;
    overrun[8] = 128 + 127;  // the third run of the first component passes 300
    fails_with(joined(two, overrun), "passes the end");
    Bytes empty_run = row;
    empty_run[4] = 0;
    fails_with(joined(two, empty_run), "run is empty");

    fails_with(joined(hdr_header("-Y 1 +X 3"), {1, 1, 1, 2, 9, 9, 9, 9}), "starts with a repetition");
    fails_with(joined(hdr_header("-Y 1 +X 3"), {9, 9, 9, 9, 1, 1, 1, 3}), "passes the end");
    fails_with(joined(hdr_header("-Y 1 +X 3"), {9, 9, 9, 9, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0}),
               "never ends");

    fails_with(hdr_header("-Y 0 +X 0"), "no texels");
    fails_with(hdr_header("-Y -5 +X 10"), "no texels");
    fails_with(hdr_header("-Y 100000 +X 100000"), "longer than");
    fails_with(hdr_header("-Y 40000 +X 40000"), "file ends too early");
    fails_with(hdr_header("-Y 99999999999999999999 +X 2"), "resolution line");
    fails_with(hdr_header("-Y 2 +Y 2"), "resolution line");
    fails_with(hdr_header("512 1024"), "resolution line");
    fails_with(hdr_header("-Y 1 +X 1", "FORMAT=32-bit_rle_spectral\n"), "FORMAT");
    fails_with(bytes_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"), "file ends inside the header");
}

TEST_CASE("hdr reader: images stored by columns respect the memory limit") {
    const Bytes file = encode(300, 20, true, false, false, new_rle_scanline);
    CHECK(read_bytes(file, {.max_bytes = 24000}));
    const auto refused = read_bytes(file, {.max_bytes = 23999});
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("limit") != std::string::npos);
}

TEST_CASE("hdr reader: the shortest possible scanline is never longer than a real one") {
    for (const int width : {1, 2, 8, 255, 256, 257, 20000, 40000, 65536}) {
        const std::vector<Rgbe> equal(std::size_t(width), Rgbe{9, 8, 7, 6});
        CHECK(least_hdr_scanline_bytes(width) == old_rle_scanline(equal).size());
        if (width >= 8 && width < 32768) CHECK(least_hdr_scanline_bytes(width) <= new_rle_scanline(equal).size());
    }
}
