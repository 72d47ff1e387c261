// What PNG and JPEG files say of their colours and of the way that they are to be seen.
#include "io/picture/exif.h"
#include "io/picture/icc_profile.h"
#include "io/picture/oriented_reader.h"
#include "io/picture/png_colour.h"
#include "io/reader_samples.h"
#include "test.h"

#include <lcms2.h>
#include <png.h>

#include <cmath>

using namespace domelight;
using namespace domelight::test;

namespace {

Bytes big_endian(std::initializer_list<std::uint32_t> numbers) {
    Bytes bytes;
    for (const std::uint32_t n : numbers)
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::uint8_t(n >> shift));
    return bytes;
}

/// A chunk with its check sum (PNG specification, annex D).
Bytes chunk(const std::string& type, const Bytes& contents) {
    const Bytes body = joined(bytes_of(type), contents);
    std::uint32_t crc = 0xffffffff;
    for (const std::uint8_t byte : body) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
    }
    return joined(joined(big_endian({std::uint32_t(contents.size())}), body), big_endian({~crc}));
}

/// A PNG of 2 x 1 texels of these codes, with the chunks behind its header. `icc` goes into iCCP.
Bytes png(const std::vector<std::uint8_t>& codes, const Bytes& chunks, const Bytes& icc = {}, int width = 2) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width), image.height = png_uint_32(int(codes.size()) / 3 / width);
    image.format = PNG_FORMAT_RGB;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    Bytes out;
    png_set_write_fn(
        writer, &out,
        [](png_structp p, png_bytep data, std::size_t n) {
            auto* bytes = static_cast<Bytes*>(png_get_io_ptr(p));
            bytes->insert(bytes->end(), data, data + n);
        },
        [](png_structp) {});
    png_set_IHDR(writer, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!icc.empty()) png_set_iCCP(writer, info, "profile", 0, icc.data(), png_uint_32(icc.size()));
    png_write_info(writer, info);
    for (std::size_t row = 0; row < codes.size(); row += std::size_t(3 * width)) png_write_row(writer, &codes[row]);
    png_write_end(writer, info);
    png_destroy_write_struct(&writer, &info);
    constexpr std::ptrdiff_t header_end = 8 + 25;
    out.insert(out.begin() + header_end, chunks.begin(), chunks.end());
    return out;
}

const std::vector<std::uint8_t> k_codes{128, 128, 128, 191, 64, 10};

struct Opened {
    ImageFacts facts;
    ImageF image;
    /// The texel in linear Rec. 709.
    Vec3d at(int x, int y = 0) const {
        const float* p = image.at(x, y);
        const Vec3d v(p[0], p[1], p[2]);
        return facts.to_rec709 ? *facts.to_rec709 * v : v;
    }
};

Opened opened(const Bytes& file, const ReaderOptions& options = {}) {
    const auto reader = open_bytes(file, options);
    REQUIRE_MESSAGE(reader, reader.error().format());
    auto image = read_all(**reader);
    REQUIRE_MESSAGE(image, image.error().format());
    return {(*reader)->facts(), *std::move(image)};
}

bool close(const Vec3d& a, const Vec3d& b, double tolerance = 1e-4) {
    const Vec3d d = a - b;
    return std::abs(d.x) < tolerance && std::abs(d.y) < tolerance && std::abs(d.z) < tolerance;
}

Vec3d grey(double v) {
    return {v, v, v};
}

const double k_srgb_128 = 0.2158605;
const double k_half = 128 / 255.0;

Bytes profile_of(cmsHPROFILE profile) {
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile, nullptr, &size);
    Bytes bytes(size);
    cmsSaveProfileToMem(profile, bytes.data(), &size);
    cmsCloseProfile(profile);
    return bytes;
}

Bytes display_profile(const cmsCIExyYTRIPLE& primaries, double gamma) {
    const cmsCIExyY d65{0.3127, 0.3290, 1};
    cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
    cmsToneCurve* const curves[] = {curve, curve, curve};
    cmsHPROFILE profile = cmsCreateRGBProfile(&d65, &primaries, curves);
    cmsFreeToneCurve(curve);
    return profile_of(profile);
}

constexpr cmsCIExyYTRIPLE k_rec709{{0.640, 0.330, 1}, {0.300, 0.600, 1}, {0.150, 0.060, 1}};
constexpr cmsCIExyYTRIPLE k_p3{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
constexpr double k_p3_to_rec709_red[3] = {1.22494, -0.22494, 0};

}  // namespace

TEST_CASE("png colour: gAMA and cHRM") {
    const Opened linear = opened(png(k_codes, chunk("gAMA", big_endian({100000}))));
    CHECK(close(linear.at(0), grey(k_half)));
    const Opened power = opened(png(k_codes, chunk("gAMA", big_endian({50000}))));
    CHECK(close(power.at(0), grey(k_half * k_half)));
    CHECK(power.facts.warnings.size() == 2);
    const Opened useless = opened(png(k_codes, chunk("gAMA", big_endian({0}))));
    CHECK(close(useless.at(0), grey(k_srgb_128)));
    CHECK(useless.facts.warnings.size() == 3);
    // Display P3. Red alone becomes a red that Rec. 709 cannot show.
    const Bytes p3 = chunk("cHRM", big_endian({31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}));
    const Opened wide = opened(png({255, 0, 0, 128, 128, 128}, joined(chunk("gAMA", big_endian({100000})), p3)));
    CHECK(std::abs(wide.at(0).x - k_p3_to_rec709_red[0]) < 1e-3);
    CHECK(wide.at(0).y < 0);
    CHECK(close(wide.at(1), grey(k_half), 1e-3));
}

TEST_CASE("png colour: cICP has PQ, HLG and primaries") {
    const auto cicp = [](std::uint8_t primaries, std::uint8_t transfer, std::uint8_t matrix = 0,
                         std::uint8_t full = 1) {
        return chunk("cICP", {primaries, transfer, matrix, full});
    };
    // A code of 148 is 203 cd/m² by PQ (58 %), 100 % is 10000.
    const Opened pq = opened(png({148, 148, 148, 255, 255, 255}, cicp(1, 16)));
    CHECK(close(pq.at(0), grey(1), 0.02));
    CHECK(close(pq.at(1), grey(10000 / 203.0), 1e-3));
    CHECK(pq.facts.high_dynamic_range);
    const Opened hlg = opened(png({191, 191, 191, 255, 255, 255}, cicp(1, 18)));
    CHECK(close(hlg.at(0), grey(1), 0.01));
    CHECK(close(hlg.at(1), grey(1 / 0.264963), 1e-3));
    const Opened wide = opened(png({255, 0, 0, 128, 128, 128}, cicp(12, 8)));
    CHECK(std::abs(wide.at(0).x - k_p3_to_rec709_red[0]) < 1e-3);
    CHECK(close(wide.at(1), grey(k_half), 1e-3));
    CHECK_FALSE(wide.facts.high_dynamic_range);
    const Opened narrow = opened(png({16, 16, 16, 235, 235, 235}, cicp(1, 8, 0, 0)));
    CHECK(close(narrow.at(0), grey(0)));
    CHECK(close(narrow.at(1), grey(1)));
    // What is not known is said, and the next in rank counts.
    const Opened unknown = opened(png(k_codes, joined(cicp(1, 99), chunk("gAMA", big_endian({100000})))));
    CHECK(close(unknown.at(0), grey(k_half)));
    CHECK(unknown.facts.warnings.size() == 3);
    CHECK(opened(png(k_codes, cicp(1, 13, 9))).facts.warnings.size() == 3);
}

TEST_CASE("png colour: the order of precedence is cICP, iCCP, sRGB, gAMA") {
    const Bytes cicp = chunk("cICP", {1, 8, 0, 1}), srgb = chunk("sRGB", {0}),
                gama = chunk("gAMA", big_endian({50000}));
    const Bytes icc = display_profile(k_rec709, 1.5);
    const double by_cicp = k_half, by_icc = std::pow(k_half, 1.5), by_srgb = k_srgb_128, by_gamma = k_half * k_half;
    CHECK(close(opened(png(k_codes, joined(cicp, gama), icc)).at(0), grey(by_cicp)));
    CHECK(close(opened(png(k_codes, gama, icc)).at(0), grey(by_icc), 1e-3));
    const Opened says_srgb = opened(png(k_codes, joined(srgb, gama)));
    CHECK(close(says_srgb.at(0), grey(by_srgb)));
    CHECK(says_srgb.facts.warnings.size() == 1);  // nothing is assumed
    CHECK(close(opened(png(k_codes, gama)).at(0), grey(by_gamma)));
    // A decoding that is asked for counts more than all of them.
    CHECK(close(opened(png(k_codes, joined(cicp, gama), icc), {.decode = Decode::srgb}).at(0), grey(by_srgb)));
}

TEST_CASE("icc profiles: curves with a matrix, tables, grey, sRGB, and damaged ones") {
    const auto p3 = colour_of_icc_profile(display_profile(k_p3, 2), 256);
    REQUIRE(p3);
    REQUIRE(p3->to_rec709);
    CHECK(std::abs(p3->to_rec709->row[0].x - k_p3_to_rec709_red[0]) < 1e-3);
    CHECK(std::abs(p3->curves[1][128] - k_half * k_half) < 1e-4);
    CHECK(p3->notes.size() == 1);

    const auto srgb = colour_of_icc_profile(profile_of(cmsCreate_sRGBProfile()), 256);
    REQUIRE(srgb);
    CHECK(srgb->curves[2] == screen_curve(Decode::srgb, 256));
    CHECK(!srgb->to_rec709);
    CHECK(srgb->notes.empty());

    const cmsCIExyY d65{0.3127, 0.3290, 1};
    cmsToneCurve* curve = cmsBuildGamma(nullptr, 1.8);
    const auto one = colour_of_icc_profile(profile_of(cmsCreateGrayProfile(&d65, curve)), 256);
    cmsFreeToneCurve(curve);
    REQUIRE(one);
    CHECK(std::abs(one->curves[0][128] - std::pow(k_half, 1.8)) < 1e-3);

    // The same as tables: a device link from P3 to Lab, made a profile.
    const Bytes matrix = display_profile(k_p3, 2);
    cmsHPROFILE device = cmsOpenProfileFromMem(matrix.data(), cmsUInt32Number(matrix.size()));
    cmsHPROFILE lab = cmsCreateLab4Profile(nullptr);
    cmsHTRANSFORM link =
        cmsCreateTransform(device, TYPE_RGB_16, lab, TYPE_Lab_16, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
    cmsHPROFILE tables = cmsTransform2DeviceLink(link, 4.3, cmsFLAGS_GUESSDEVICECLASS | cmsFLAGS_FORCE_CLUT);
    const auto table = colour_of_icc_profile(profile_of(tables), 256);
    cmsDeleteTransform(link), cmsCloseProfile(lab), cmsCloseProfile(device);
    REQUIRE_MESSAGE(table, table.error().what);
    REQUIRE(table->profile);
    float texels[6] = {float(k_half), float(k_half), float(k_half), 1, 0, 0};
    table->profile(texels, 2);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(texels[c] - k_half * k_half) < 3e-3);  // cells of tables
    CHECK(std::abs(texels[3] - k_p3_to_rec709_red[0]) < 5e-3);

    CHECK_FALSE(colour_of_icc_profile(Bytes(matrix.begin(), matrix.begin() + 100), 256));
    for (std::size_t i = 0; i < matrix.size(); i += 7) {
        Bytes changed = matrix;
        changed[i] ^= 0xff;
        const auto any = colour_of_icc_profile(changed, 256);
        if (any)
            for (const float v : any->curves[0]) REQUIRE((v >= 0 && v < 100));
    }
}

TEST_CASE("png colour: the 16 bits of linear light") {
    DOMELIGHT_DATA_FILE(file, "reports/p_gama1_16.png");
    const Opened picture = opened(load(file));
    CHECK(close(picture.at(0), {0.3046, 0.1609, 0.8955}));
}

TEST_CASE("exif orientation: all eight, and damaged ones") {
    // Stored as 3 x 2; letters are what is seen.
    const char* const seen[9] = {"",         "abc/def",  "cba/fed",  "fed/cba", "def/abc",
                                 "ad/be/cf", "da/eb/fc", "fc/eb/da", "cf/be/ad"};
    Bytes codes;
    for (int i = 0; i < 6; ++i) codes.insert(codes.end(), 3, std::uint8_t('a' + i));
    for (const bool little : {false, true})
        for (int orientation = 1; orientation <= 8; ++orientation) {
            const auto o = std::uint8_t(orientation);
            const Bytes exif = little ? Bytes{'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3, 0, 1, 0, 0, 0, o, 0, 0, 0}
                                      : Bytes{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, o, 0, 0};
            const Bytes file = png(codes, chunk("eXIf", exif), {}, 3);
            const Opened picture = opened(file, {.decode = Decode::linear});
            std::string letters;
            for (int y = 0; y < picture.image.height(); ++y) {
                if (y) letters += '/';
                for (int x = 0; x < picture.image.width(); ++x)
                    letters += char(std::lround(picture.image.at(x, y)[0] * 255));
            }
            CHECK(letters == seen[orientation]);
            CHECK(picture.facts.warnings.size() == (orientation == 1 ? 1 : 2));
            CHECK(opened(file, {.decode = Decode::linear, .as_stored = true}).image.width() == 3);
            for (std::size_t length = 0; length < exif.size(); ++length)
                exif_orientation(std::span(exif).first(length));  // no further than the end
        }
    CHECK(exif_orientation(Bytes{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, 9, 0, 0}) == 1);
    const Bytes turned{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, 3};
    CHECK_FALSE(open_bytes(png(codes, chunk("eXIf", turned), {}, 3), {.max_bytes = 71}));
}

TEST_CASE("jpeg reader: Exif's orientation turns the picture as the other files of it") {
    DOMELIGHT_DATA_FILE(turned, "reports/j_exif3.jpg");
    DOMELIGHT_DATA_FILE(straight, "reports/j_ok.jpg");
    const Opened a = opened(load(turned)), b = opened(load(straight));
    double largest = 0;
    for (int y = 0; y < b.image.height(); ++y)
        for (int x = 0; x < b.image.width(); ++x)
            largest = std::max(largest, double(std::abs(a.image.at(x, y)[0] - b.image.at(x, y)[0])));
    CHECK(largest < 0.05);  // both were compressed, each in its own blocks
}
