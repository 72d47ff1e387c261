#include "domelight/projection/projection.h"
#include "domelight/texture/texture.h"

#include "test.h"
#include "texture/chain_encoder.h"
#include "texture/texel/encode_row.h"
#include "texture/texel/encode_row_simd.h"

#include <cmath>
#include <limits>

using namespace domelight;

namespace {

constexpr Encoding k_all[] = {Encoding::rgba16f, Encoding::rgba32f, Encoding::rgb9e5, Encoding::r11g11b10f,
                              Encoding::rg16f,   Encoding::rg32f,   Encoding::rgbm,   Encoding::rgbd,
                              Encoding::rgbp,    Encoding::bc6h};

float noise(std::uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) * 0x1p-24f;
}

/// A cube chain of smooth noise with a bright texel.
std::vector<FilteredMap> cube_chain(int size, int levels, float peak) {
    std::vector<FilteredMap> chain(static_cast<std::size_t>(levels));
    std::uint32_t state = 7;
    for (int l = 0; l < levels; ++l) {
        chain[std::size_t(l)] = Cubemap(std::max(1, size >> l));
        for (float& p : chain[std::size_t(l)].pixels()) p = std::exp2(8 * noise(state) - 4);
        chain[std::size_t(l)].pixels()[4] = peak;  // green of the second texel
    }
    return chain;
}

}  // namespace

TEST_CASE("encode_texture: decoding gives back what the encoding can hold") {
    const auto chain = cube_chain(16, 5, 50);
    // Relative to the largest channel of a texel: half a unit in the last place.
    const auto tolerance = [](Encoding e, double largest) {
        switch (e) {
            case Encoding::rgba32f:
            case Encoding::rg32f:
                return 0.0;
            case Encoding::rgb9e5:
                return std::exp2(-9);
            case Encoding::r11g11b10f:
                return std::exp2(-6);
            // Half a step of 8 bits below a square or a power of 2.2. Below 1 rgbp and rgbd have no scale to spare.
            case Encoding::rgbm:
                return 1 / 120.0;
            case Encoding::rgbp:
                return 1 / 120.0 / std::sqrt(std::min(largest, 1.0));
            case Encoding::rgbd:
                return 1 / 110.0 / std::sqrt(std::min(largest, 1.0));
            case Encoding::bc6h:
                return 1.0;  // blocks cannot represent noise; see bc6h_test.cpp
            default:
                return std::exp2(-11);
        }
    };
    for (Encoding e : k_all) {
        std::vector<EncodingReport> reports;
        const Texture texture = encode_texture(chain, e, 2, &reports);
        REQUIRE(texture.levels.size() == 5);
        CHECK(texture.faces == 6);
        CHECK(texture.width == 16);
        for (int l = 0; l < 5; ++l) {
            const int side = std::max(1, (16 >> l) / encoding_block(e));
            CHECK(texture.levels[std::size_t(l)].size() == std::size_t(6 * side * side * encoding_bytes(e)));
            CHECK(reports[std::size_t(l)].clipped_texels == 0);
            CHECK(reports[std::size_t(l)].clipped_energy == 0);
            CHECK(reports[std::size_t(l)].rms_error <= tolerance(e, 1));
            for (int face = 0; face < 6; ++face) {
                const ImageF back = decode_texture(texture, l, face);
                const auto source = chain[std::size_t(l)].face(face);
                for (int y = 0; y < back.height(); ++y)
                    for (int x = 0; x < back.width(); ++x) {
                        const float* v = source.at(x, y);
                        const double largest = std::max({v[0], v[1], v[2]});
                        for (int c = 0; c < back.channels(); ++c)
                            if (e != Encoding::bc6h)
                                REQUIRE(std::abs(back.at(x, y)[c] - v[c]) <= tolerance(e, largest) * largest);
                    }
            }
        }
        if (e == Encoding::rgba16f) {
            const std::uint8_t* alpha = texture.levels[0].data() + 6;
            CHECK((alpha[0] | alpha[1] << 8) == 0x3c00);
        }
    }
}

TEST_CASE("encode_texture: what is clipped is counted and weighed by solid angle") {
    const int size = 32;
    std::vector<FilteredMap> chain(1);
    chain[0] = Cubemap(size);
    for (float& p : chain[0].pixels()) p = 1;
    // One texel in a corner, where solid angle is smallest, and one in a centre.
    const auto face = chain[0].face(2);
    face.at(0, 0)[0] = 200000;
    face.at(15, 15)[1] = 100000;
    std::vector<EncodingReport> reports;
    const Texture texture = encode_texture(chain, Encoding::rgba16f, 1, &reports);
    CHECK(reports[0].clipped_texels == 2);
    const double corner = cube_solid_angle(0, 0, size), centre = cube_solid_angle(15, 15, size);
    const double lost = 0.2126 * (200000 - 65504) * corner + 0.7152 * (100000 - 65504) * centre;
    const double power = 4 * k_pi + 0.2126 * 199999 * corner + 0.7152 * 99999 * centre;
    // The report weighs with the density at texel centres: off by about 1 / size^2.
    CHECK(reports[0].clipped_energy == doctest::Approx(lost / power).epsilon(2e-3));
    CHECK(reports[0].rms_error == 0);  // ones are exact, the clipped are left out
    CHECK(decode_texture(texture, 0, 2).at(0, 0)[0] == 65504);
}

TEST_CASE("encode_texture: the PSNR of logarithms is as defined") {
    // Half the texels 1, half 2^8; rgb9e5 keeps both exactly, so a texel is put where its mantissas are coarse: green
    // of 0.7 beside red of 256 is stored as 1, in steps of 1.
    const int size = 16;
    std::vector<FilteredMap> chain(1);
    chain[0] = Cubemap(size);
    const auto pixels = chain[0].pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = i / 3 % 2 ? 256 : 1;
    float* texel = chain[0].face(4).at(3, 5);
    texel[0] = 256, texel[1] = 0.7f, texel[2] = 256;
    std::vector<EncodingReport> reports;
    encode_texture(chain, Encoding::rgb9e5, 1, &reports);
    double mean = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 3)
        mean += (0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2]) / (6 * size * size);
    const double floor = 1e-4 * mean, range = std::log2((256 + floor) / (0.7 + floor)),
                 error = std::log2((1 + floor) / (0.7 + floor)), share = cube_solid_angle(3, 5, size) / (4 * k_pi) / 3;
    CHECK(reports[0].log_psnr ==
          doctest::Approx(10 * std::log10(range * range / (error * error * share))).epsilon(1e-3));
    std::fill(pixels.begin(), pixels.end(), 1.0f);
    encode_texture(chain, Encoding::rgb9e5, 1, &reports);
    CHECK(std::isinf(reports[0].log_psnr));
}

TEST_CASE("rgbe_reports: a mantissa's error, nothing clipped but what is negative") {
    auto chain = cube_chain(16, 2, 1e6f);
    auto reports = rgbe_reports(chain);
    REQUIRE(reports.size() == 2);
    for (const EncodingReport& r : reports) {
        CHECK(r.clipped_texels == 0);
        CHECK(r.rms_error > 1e-5);
        CHECK(r.rms_error < std::exp2(-9));
        CHECK(r.log_psnr > 40);  // a channel 2^8 darker than the largest has one bit
    }
    chain[0].pixels()[0] = -1;
    CHECK(rgbe_reports(chain)[0].clipped_texels == 1);
}

TEST_CASE("encode_texture: lat-long rows weigh by their solid angle") {
    std::vector<FilteredMap> chain(1);
    chain[0] = {Layout::latlong, ImageF(32, 16, 3, 1.0f)};
    chain[0].image.at(3, 0)[1] = 1e6f;
    std::vector<EncodingReport> reports;
    const Texture texture = encode_texture(chain, Encoding::rgb9e5, 1, &reports);
    CHECK(texture.faces == 1);
    const double texel = latlong_solid_angle(0, 32, 16);
    const double expected = 0.7152 * (1e6 - 65408) * texel / (4 * k_pi + 0.7152 * 999999 * texel);
    CHECK(reports[0].clipped_energy == doctest::Approx(expected).epsilon(5e-3));
}

TEST_CASE("encode_texture: the same bytes and reports on any number of threads") {
    const auto chain = cube_chain(64, 7, 1e6f);
    for (Encoding e : k_all) {
        std::vector<EncodingReport> first, again;
        const Texture texture = encode_texture(chain, e, 1, &first);
        for (int threads : {2, 3, 8}) {
            const Texture other = encode_texture(chain, e, threads, &again);
            CHECK(other.levels == texture.levels);
            for (std::size_t l = 0; l < first.size(); ++l) {
                CHECK(first[l].clipped_texels == again[l].clipped_texels);
                CHECK(first[l].clipped_energy == again[l].clipped_energy);
                CHECK(first[l].rms_error == again[l].rms_error);
                CHECK(first[l].log_psnr == again[l].log_psnr);
            }
        }
    }
}

TEST_CASE("encode_row: the fast rows agree with the plain ones") {
    std::vector<float> rgb;
    std::uint32_t state = 3;
    for (int i = 0; i < 3 * 1031; ++i)
        rgb.push_back(std::exp2(40 * noise(state) - 24) * (noise(state) < 0.05f ? -1.0f : 1.0f));
    rgb[5] = std::numeric_limits<float>::quiet_NaN();
    rgb[20] = 1e5f;
    rgb[31] = 0;
    const std::vector<float> special{65504, 65519,    65520,    65408,    65409,  65024,
                                     64512, 0x1p-14f, 0x1p-24f, 0x1p-25f, 1e-40f, 511.6f / 512};
    std::copy(special.begin(), special.end(), rgb.begin() + 300);
    std::vector<float> weight(1031);
    for (float& w : weight) w = 0.5f + noise(state);
    for (Encoding e : k_all)
        for (int count : {0, 1, 3, 7, 8, 9, 16, 17, 31, 1031}) {
            const std::size_t bytes = std::size_t(count * encoding_bytes(e));
            std::vector<std::uint8_t> plain(bytes + 8, 0xaa), fast(bytes + 8, 0xaa);
            if (encoding_block(e) > 1) continue;
            const EncodeSums a = encode_row_scalar(e, rgb.data(), count, weight.data(), 1e-3f, plain.data());
            const EncodeSums b = simd::encode_row(e, rgb.data(), count, weight.data(), 1e-3f, fast.data());
            REQUIRE(plain == fast);
            CHECK(a.clipped == b.clipped);
            // Sums of up to 1031 floats: a few hundred roundings of 6e-8.
            CHECK(b.power == doctest::Approx(a.power).epsilon(1e-5));
            CHECK(b.lost == doctest::Approx(a.lost).epsilon(1e-5));
            CHECK(b.error == doctest::Approx(a.error).epsilon(1e-4));
            CHECK(b.norm == doctest::Approx(a.norm).epsilon(1e-5));
            CHECK(b.log_norm == doctest::Approx(a.log_norm).epsilon(1e-5));
            CHECK(b.log_error == doctest::Approx(a.log_error).epsilon(1e-3));  // the vector code has its own logarithm
        }
    // The texels as they would be decoded, with a small error.
    std::vector<float> stored(rgb.size());
    for (std::size_t i = 0; i < rgb.size(); ++i) stored[i] = limit_to(rgb[i], 0, 65504) * (0.9f + 0.2f * noise(state));
    for (int count : {0, 5, 16, 1031}) {
        const EncodeSums a = compare_row_scalar(rgb.data(), stored.data(), count, weight.data(), 0, 65504, 1e-3f);
        const EncodeSums b = simd::compare_row(rgb.data(), stored.data(), count, weight.data(), 0, 65504, 1e-3f);
        CHECK(a.clipped == b.clipped);
        CHECK(b.power == doctest::Approx(a.power).epsilon(1e-5));
        CHECK(b.lost == doctest::Approx(a.lost).epsilon(1e-5));
        CHECK(b.error == doctest::Approx(a.error).epsilon(1e-4));
        CHECK(b.log_error == doctest::Approx(a.log_error).epsilon(1e-4));
    }
}

TEST_CASE("encode_table: two and three channels, and missing ones are zero") {
    ImageF two(4, 2, 2), three(4, 2, 3);
    for (std::size_t i = 0; i < two.pixels().size(); ++i) two.pixels()[i] = float(i) / 8;
    for (std::size_t i = 0; i < three.pixels().size(); ++i) three.pixels()[i] = float(i) / 8;
    const ImageF one = decode_texture(encode_table(two, Encoding::r32f), 0, 0);
    CHECK(one.channels() == 1);
    for (int x = 0; x < two.width(); ++x) CHECK(one.at(x, 0)[0] == two.at(x, 0)[0]);
    const ImageF a = decode_texture(encode_table(two, Encoding::rg32f), 0, 0);
    REQUIRE(a.channels() == 2);
    CHECK(std::equal(a.pixels().begin(), a.pixels().end(), two.pixels().begin()));
    const ImageF b = decode_texture(encode_table(three, Encoding::rg16f), 0, 0);
    CHECK(b.at(1, 1)[0] == three.at(1, 1)[0]);
    CHECK(b.at(1, 1)[1] == three.at(1, 1)[1]);
    const ImageF c = decode_texture(encode_table(two, Encoding::rgba16f), 0, 0);
    REQUIRE(c.channels() == 3);
    CHECK(c.at(2, 1)[1] == two.at(2, 1)[1]);
    CHECK(c.at(2, 1)[2] == 0);
}
