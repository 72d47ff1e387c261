// Gain maps: photographs whose JPEG holds a picture for a screen and what makes HDR of it.
#include "io/picture/gain_map.h"

#include "io/jpeg_sample.h"
#include "io/picture/exif.h"
#include "io/reader_samples.h"
#include "test.h"

#include <cmath>
#include <cstdlib>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A JPEG of 32 x 16 texels: `left` in the left half and `right` in the other.
Bytes make_jpeg(std::array<std::uint8_t, 3> left, std::array<std::uint8_t, 3> right) {
    Bytes rows;
    for (int i = 0; i < 32 * 16; ++i) {
        const auto& colour = i % 32 < 16 ? left : right;
        rows.insert(rows.end(), colour.begin(), colour.end());
    }
    return encode_jpeg({.width = 32, .height = 16, .whole_chroma = true}, std::move(rows));
}

/// The JPEG with one more segment at its start.
Bytes with_segment(const Bytes& jpeg, std::uint8_t marker, const Bytes& contents) {
    const std::size_t length = contents.size() + 2;
    const Bytes head{0xff, 0xd8, 0xff, marker, std::uint8_t(length >> 8), std::uint8_t(length)};
    return joined(joined(head, contents), Bytes(jpeg.begin() + 2, jpeg.end()));
}

Bytes zero_ended(const std::string& text) {
    return joined(bytes_of(text), {0});
}

Bytes numbers(std::initializer_list<std::int32_t> values) {
    Bytes bytes;
    for (const std::int32_t v : values)
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::uint8_t(std::uint32_t(v) >> shift));
    return bytes;
}

Bytes xmp(const std::string& text) {
    return joined(zero_ended("http://ns.adobe.com/xap/1.0/"), bytes_of(text));
}

Bytes iso(const Bytes& metadata) {
    return joined(zero_ended("urn:iso:std:iso:ts:21496:-1"), metadata);
}

const std::string k_hdrgm = "<rdf:Description xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" ";

/// White and black, and a map that is full over the left half and empty over the other.
const Bytes k_base = make_jpeg({255, 255, 255}, {188, 188, 188}), k_map = make_jpeg({255, 255, 255}, {0, 0, 0});

Result<ImageF> with_map(std::uint8_t marker, const Bytes& metadata, const Bytes& base = k_base) {
    return read_bytes(joined(base, with_segment(k_map, marker, metadata)));
}

const double k_grey = 0.50289;  // sRGB 188

void check_texels(const Result<ImageF>& image, std::array<double, 3> left, double right) {
    REQUIRE_MESSAGE(image, image.error().format());
    for (int c = 0; c < 3; ++c) {
        CHECK(image->at(2, 8)[c] == doctest::Approx(left[std::size_t(c)]).epsilon(1e-4));
        CHECK(image->at(29, 8)[c] == doctest::Approx(right).epsilon(0.01));
    }
}

}  // namespace

TEST_CASE("gain maps: ISO 21496-1, for all channels together, for each, and with one denominator") {
    // Headrooms 0 and 3; least 0, most 3, gamma 1, offsets 1/64.
    const Bytes head{0, 0, 0, 0, 0x40};
    const Bytes one = numbers({0, 1, 3, 1, 0, 1, 3, 1, 1, 1, 1, 64, 1, 64});
    check_texels(with_map(0xe2, iso(joined(head, one))), std::array{8 + 7 / 64.0, 8 + 7 / 64.0, 8 + 7 / 64.0}, k_grey);
    const Bytes three =
        joined(numbers({0, 1, 3, 1}),
               joined(numbers({0, 1, 1, 1, 1, 1, 0, 1, 0, 1}),
                      joined(numbers({0, 1, 2, 1, 1, 1, 0, 1, 0, 1}), numbers({0, 1, 6, 2, 1, 1, 0, 1, 0, 1}))));
    check_texels(with_map(0xe2, iso(joined({0, 0, 0, 0, 0xc0}, three))), std::array{2.0, 4.0, 8.0}, k_grey);
    const Bytes shared = numbers({2, 0, 6, -2, 4, 2, 0, 0});
    check_texels(with_map(0xe2, iso(joined({0, 0, 0, 0, 0x48}, shared))), std::array{4.0, 4.0, 4.0}, k_grey / 2);
    // A base that is HDR already is taken as it is, and so is one whose metadata are cut or absurd.
    const Bytes other_way = numbers({3, 1, 0, 1, 0, 1, 3, 1, 1, 1, 1, 64, 1, 64});
    check_texels(with_map(0xe2, iso(joined(head, other_way))), std::array{1.0, 1.0, 1.0}, k_grey);
    check_texels(with_map(0xe2, iso(joined(head, Bytes(one.begin(), one.end() - 1)))), std::array{1.0, 1.0, 1.0},
                 k_grey);
    check_texels(with_map(0xe2, iso(joined(head, numbers({0, 1, 3, 1, 0, 1, 3, 0, 1, 1, 1, 64, 1, 64})))),
                 std::array{1.0, 1.0, 1.0}, k_grey);
}

TEST_CASE("gain maps: Adobe's and Google's XMP, as attributes and as lists") {
    check_texels(with_map(0xe1, xmp(k_hdrgm + "hdrgm:Version=\"1.0\" hdrgm:GainMapMin=\"-1\" hdrgm:GainMapMax=\"2\" "
                                              "hdrgm:OffsetSDR=\"0\" hdrgm:OffsetHDR=\"0\"/>")),
                 std::array{4.0, 4.0, 4.0}, k_grey / 2);
    check_texels(with_map(0xe1, xmp(k_hdrgm + "hdrgm:OffsetSDR=\"0\" hdrgm:OffsetHDR=\"0\"><hdrgm:GainMapMax><rdf:Seq>"
                                              "<rdf:li>1</rdf:li><rdf:li>2</rdf:li><rdf:li>3.0</rdf:li></rdf:Seq>"
                                              "</hdrgm:GainMapMax></rdf:Description>")),
                 std::array{2.0, 4.0, 8.0}, k_grey);
    // What is left out has its default: offsets of 1/64.
    check_texels(with_map(0xe1, xmp(k_hdrgm + "hdrgm:GainMapMax=\"1\"/>")),
                 std::array{2 + 1 / 64.0, 2 + 1 / 64.0, 2 + 1 / 64.0}, k_grey);
}

TEST_CASE("gain maps: Apple's, by its stated headroom or by the maker note") {
    const std::string says =
        "<apdi:AuxiliaryImageType>urn:com:apple:photo:2020:aux:hdrgainmap</apdi:AuxiliaryImageType>";
    check_texels(with_map(0xe1, xmp(says + "<HDRGainMap:HDRGainMapHeadroom>5.5</HDRGainMap:HDRGainMapHeadroom>")),
                 std::array{5.5, 5.5, 5.5}, k_grey);
    // Exif: a pointer to the Exif directory, in it the maker note with the tags 33 (1/1) and 48 (0/1): three stops.
    const Bytes note =
        joined(joined(zero_ended("Apple iOS"), {0, 0, 'M', 'M', 0, 2}),
               joined(joined({0, 33, 0, 10, 0, 0, 0, 1, 0, 0, 0, 44}, {0, 48, 0, 10, 0, 0, 0, 1, 0, 0, 0, 52}),
                      joined(numbers({0, 1, 1, 0}), {0, 0, 0, 1})));
    const auto length = std::uint8_t(note.size());
    const Bytes exif =
        joined(joined({'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 0x87, 0x69, 0, 4, 0, 0, 0, 1, 0, 0, 0, 26, 0, 0, 0, 0},
                      {0, 1, 0x92, 0x7c, 0, 7, 0, 0, 0, length, 0, 0, 0, 44, 0, 0, 0, 0}),
               note);
    REQUIRE(apple_headroom(exif));
    CHECK(*apple_headroom(exif) == doctest::Approx(8));
    for (std::size_t n = 0; n < exif.size(); ++n) apple_headroom(std::span(exif).first(n));  // no further than the end
    check_texels(with_map(0xe1, xmp(says), with_segment(k_base, 0xe1, joined({'E', 'x', 'i', 'f', 0, 0}, exif))),
                 std::array{8.0, 8.0, 8.0}, k_grey);
    // Without either, nothing is known.
    check_texels(with_map(0xe1, xmp(says)), std::array{1.0, 1.0, 1.0}, k_grey);
}

TEST_CASE("gain maps: a decoding that is asked for has the picture for a screen, and missing ones are told") {
    const Bytes metadata = xmp(k_hdrgm + "hdrgm:GainMapMax=\"1\"/>");
    const Bytes file = joined(k_base, with_segment(k_map, 0xe1, metadata));
    CHECK((*open_bytes(file))->facts().high_dynamic_range);
    CHECK_FALSE((*open_bytes(file, {.decode = Decode::srgb}))->facts().high_dynamic_range);
    const auto missing = open_bytes(with_segment(k_base, 0xe1, metadata));
    REQUIRE(missing);
    CHECK_FALSE((*missing)->facts().high_dynamic_range);
    CHECK((*missing)->facts().warnings.size() == 3);
    for (std::size_t n = k_base.size(); n < file.size(); n += 23)
        CHECK(open_bytes(Bytes(file.begin(), file.begin() + std::ptrdiff_t(n))));
}

TEST_CASE("gain maps: a photograph in Ultra HDR is the light that another reader finds in it") {
    DOMELIGHT_DATA_FILE(jpeg, "env_highres/spruit_sunrise_4k.jpg");
    DOMELIGHT_DATA_FILE(hdr, "env_highres/spruit_sunrise_4k_from_ultrahdr.hdr");
    const auto ours = open_bytes(load(jpeg)), theirs = open_bytes(load(hdr));
    REQUIRE((ours && theirs));
    REQUIRE((*ours)->facts().width == (*theirs)->facts().width);
    // A piece from the top: the file is large.
    const int width = (*ours)->facts().width, height = 1024;
    ImageF a(width, height, 3), b(width, height, 3);
    REQUIRE((*ours)->read(a));
    REQUIRE((*theirs)->read(b));
    double sum_a = 0, sum_b = 0, far = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const double x = std::min(a.pixels()[i], 60000.0f), y = std::min(b.pixels()[i], 60000.0f);
        sum_a += x, sum_b += y;
        far += std::abs(x - y) > 0.02 * (x + y) + 0.01;
    }
    CHECK(sum_a / sum_b == doctest::Approx(1).epsilon(0.01));
    // Decoders of JPEG differ in how they enlarge chroma, and readers of gain maps in how they enlarge these: both
    // show at edges.
    CHECK(far / double(a.pixels().size()) < 0.03);
}

TEST_CASE("gain maps: a photograph by libultrahdr peaks at 20") {
    DOMELIGHT_DATA_FILE(file, "reports/j_ultra.jpg");
    const auto reader = open_bytes(load(file));
    REQUIRE(reader);
    const auto image = read_all(**reader);
    REQUIRE(image);
    float largest = 0;
    for (const float v : image->pixels()) largest = std::max(largest, v);
    CHECK(largest == doctest::Approx(20).epsilon(0.06));
}
