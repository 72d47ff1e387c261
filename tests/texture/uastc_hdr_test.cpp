#include "texture/block/uastc_hdr.h"

#include "domelight/texture/texture.h"

#include "base/instruction_set.h"
#include "io/file/file_reader.h"
#include "io/image_reader.h"
#include "test.h"
#include "texture/block/astc_codec.h"
#include "texture/block/astc_ise.h"
#include "texture/texel/half.h"
#include "texture/uastc_samples.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace domelight;

namespace {

using Bytes16 = std::array<std::uint8_t, 16>;

/// Blocks of many kinds: gradients of brightness and of colour, edges, noise, deep blacks and suns.
std::vector<float> sample_blocks(int count) {
    test::Noise noise;
    std::vector<float> rgb(std::size_t(48 * count));
    for (int b = 0; b < count; ++b) {
        const float exposure = std::exp2(24 * noise.unit() - 14), contrast = std::exp2(-6 * noise.unit()) * 4;
        const float along_x = contrast * (noise.unit() - 0.5f), along_y = contrast * (noise.unit() - 0.5f);
        const float tint[3] = {noise.unit(), noise.unit(), noise.unit()};
        const float other[3] = {noise.unit(), noise.unit(), noise.unit()};
        const int kind = b % 5, edge = noise.below(6);
        for (int i = 0; i < 16; ++i) {
            const int x = i % 4, y = i / 4;
            for (int c = 0; c < 3; ++c) {
                float v = exposure * (0.05f + tint[c]);
                if (kind == 0) v *= std::exp2(along_x * float(x) + along_y * float(y));
                if (kind == 1) v *= std::exp2((tint[c] * along_x * float(x) + other[c] * along_y * float(y)));
                if (kind == 2 && x + y > edge) v = exposure * (0.05f + other[c]) * std::exp2(along_x * float(y));
                if (kind == 3) v *= std::exp2(contrast * noise.unit());
                if (kind == 4 && i == edge) v *= 1000;
                rgb[std::size_t(48 * b + 3 * i + c)] = std::min(v, k_uastc_hdr_max);
            }
        }
    }
    return rgb;
}

std::vector<std::uint8_t> encoded(const std::vector<float>& rgb, EncodingQuality quality = EncodingQuality::standard) {
    std::vector<std::uint8_t> bytes(rgb.size() / 3);
    encode_uastc_hdr(rgb.data(), int(rgb.size() / 48), quality, bytes.data());
    return bytes;
}

std::vector<float> decoded(const std::vector<std::uint8_t>& bytes) {
    std::vector<float> rgb(bytes.size() * 3);
    decode_uastc_hdr(bytes.data(), int(bytes.size() / 16), rgb.data());
    return rgb;
}

/// Root of the mean square of the difference in octaves.
double octaves(std::span<const float> a, std::span<const float> b, double floor) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = std::log2(a[i] + floor) - std::log2(b[i] + floor);
        sum += off * off;
    }
    return std::sqrt(sum / double(a.size()));
}

AstcBlock block_at(const std::vector<std::uint8_t>& bytes, int b) {
    const auto block = unpack_astc(std::span<const std::uint8_t, 16>(bytes.data() + 16 * b, 16));
    REQUIRE(block);
    return *block;
}

}  // namespace

TEST_CASE("uastc_hdr: every block is one of the format's modes, and Arm's decoder reads the same from it") {
    const auto rgb = sample_blocks(3000);
    const auto bytes = encoded(rgb);
    std::map<std::string, int> modes;
    std::set<int> rgb_forms, scale_forms;
    for (int b = 0; b < 3000; ++b) {
        const AstcBlock block = block_at(bytes, b);
        CHECK(is_uastc_hdr(block));
        ++modes[test::mode_name(block)];
        const auto& v = block.values;
        if (block.solid) continue;
        if (block.endpoint_mode == k_cem_hdr_rgb)
            rgb_forms.insert((v[4] & v[5] & 0x80) ? 8 : v[1] >> 7 | (v[2] >> 7) << 1 | (v[3] >> 7) << 2);
        else
            scale_forms.insert(v[0] >> 6 | (v[1] >> 7) << 2 | (v[2] >> 7) << 3);
    }
    const auto ours = decoded(bytes);
    std::vector<float> theirs(rgb.size());
    decode_astc_hdr(4, bytes.data(), 3000, theirs.data());
    CHECK(ours == theirs);
    // The search uses all forms that it implements.
    for (const char* mode : {"mode 11, 1 subsets, 16 weights", "mode 11, 1 subsets, 12 weights",
                             "mode 7, 1 subsets, 16 weights", "mode 7, 2 subsets, 8 weights"})
        CHECK_MESSAGE(modes[mode] > 20, mode);
    CHECK(rgb_forms.size() == 9);
    CHECK(scale_forms.size() >= 12);  // of 16: three places of the largest channel in each of five forms, and one
}

TEST_CASE("uastc_hdr: errors in octaves are what they were when this was written") {
    const auto rgb = sample_blocks(3000);
    const auto back = decoded(encoded(rgb));
    double sum[5] = {};
    for (int b = 0; b < 3000; ++b) {
        const std::size_t at = std::size_t(48 * b);
        const double error = octaves(std::span(rgb).subspan(at, 48), std::span(back).subspan(at, 48), 1e-7);
        sum[b % 5] += error / 600;
    }
    // Means over 600 blocks each (half of them span octaves), and a tenth more: a change that costs accuracy shows.
    CHECK(sum[0] < 0.045);  // brightness
    CHECK(sum[1] < 0.053);  // colour
    CHECK(sum[2] < 0.065);  // edges
    CHECK(sum[3] < 0.21);   // noise
    CHECK(sum[4] < 0.062);  // a spot
}

TEST_CASE("uastc_hdr: more effort never costs accuracy") {
    const auto rgb = sample_blocks(1000);
    double last = 1;
    for (const auto quality :
         {EncodingQuality::fast, EncodingQuality::standard, EncodingQuality::high, EncodingQuality::exhaustive}) {
        const double error = octaves(rgb, decoded(encoded(rgb, quality)), 1e-7);
        CHECK(error <= last);
        last = error;
    }
}

TEST_CASE("uastc_hdr: a block of one colour keeps its halves") {
    test::Noise noise;
    for (int i = 0; i < 200; ++i) {
        std::uint16_t half[3];
        for (auto& h : half) h = std::uint16_t(noise.below(half_from_float(k_uastc_hdr_max) + 1));
        std::vector<float> rgb(48);
        for (std::size_t t = 0; t < 48; ++t) rgb[t] = float_from_half(half[t % 3]);
        CHECK(decoded(encoded(rgb)) == rgb);
    }
}

TEST_CASE("uastc_hdr: what cannot be held is clipped, and what is no number is black") {
    std::vector<float> rgb(48, 1.0f);
    rgb[0] = INFINITY;
    rgb[1] = 1e9f;
    rgb[2] = -5;
    rgb[3] = NAN;
    auto clipped = rgb;
    clipped[0] = clipped[1] = k_uastc_hdr_max;
    clipped[2] = clipped[3] = 0;
    CHECK(encoded(rgb) == encoded(clipped));
    for (const float v : decoded(encoded(rgb))) CHECK((v >= 0 && v <= 65504));

    std::vector<float> brightest(48, INFINITY);
    for (const float v : decoded(encoded(brightest))) CHECK(v == k_uastc_hdr_max);
    std::vector<float> darkest(48, 0.0f);
    for (const float v : decoded(encoded(darkest))) CHECK(v == 0);
    // Next to the limit, no endpoint may be rounded beyond it.
    test::Noise noise;
    std::vector<float> bright(48 * 500);
    for (float& v : bright) v = k_uastc_hdr_max * std::exp2(-0.05f * noise.unit());
    const auto bytes = encoded(bright);
    for (int b = 0; b < 500; ++b) CHECK(is_uastc_hdr(block_at(bytes, b)));
    CHECK(octaves(decoded(bytes), bright, 1e-7) < 0.02);
}

TEST_CASE("uastc_hdr: one bright texel in the dark is neither lost nor spread") {
    for (int at = 0; at < 16; ++at) {
        std::vector<float> rgb(48, 0.01f);
        for (int c = 0; c < 3; ++c) rgb[std::size_t(3 * at + c)] = 5000;
        const auto back = decoded(encoded(rgb));
        // Endpoints so far apart can only be stored in the plain form: the error is half of its steps of 1/8 octave, of
        // 1/4 for blue.
        for (std::size_t t = 0; t < 48; ++t) CHECK(std::abs(std::log2(back[t] / rgb[t])) < 0.15);
    }
}

TEST_CASE("uastc_hdr: the same bytes on every instruction set, and whatever a block's company") {
    const auto rgb = sample_blocks(333);
    const auto bytes = encoded(rgb);
    for (const char* set : {"AVX2", "SSE4", "SCALAR"}) {
        simd::limit_instruction_set(set);
        CHECK_MESSAGE(encoded(rgb) == bytes, set);
    }
    simd::limit_instruction_set("");
    for (int b = 0; b < 333; b += 7) {
        Bytes16 alone;
        encode_uastc_hdr(rgb.data() + 48 * b, 1, EncodingQuality::standard, alone.data());
        CHECK(std::equal(alone.begin(), alone.end(), bytes.begin() + 16 * b));
    }
}

TEST_CASE("uastc_hdr: the same bytes on any number of threads; the report names what was clipped") {
    std::vector<FilteredMap> chain(3);
    test::Noise noise;
    for (int l = 0; l < 3; ++l) {
        chain[std::size_t(l)] = Cubemap(26 >> l);  // not whole blocks: 26, 13, 6
        for (float& v : chain[std::size_t(l)].pixels()) v = std::exp2(3 * noise.unit());
    }
    chain[0].pixels()[100] = 1e6f;
    std::vector<EncodingReport> reports;
    const Texture one = encode_texture(chain, Encoding::uastc_hdr, 1, &reports);
    for (const int threads : {2, 3, 8}) CHECK(encode_texture(chain, Encoding::uastc_hdr, threads).levels == one.levels);
    CHECK(reports[0].clipped_texels == 1);
    CHECK(reports[0].clipped_energy > 0.5);
    CHECK(reports[1].clipped_texels == 0);
    CHECK(reports[1].rms_error > 0.01);
    CHECK(reports[1].rms_error < 0.5);
    CHECK(one.levels[1].size() == 6 * 4 * 4 * 16);
    const ImageF face = decode_texture(one, 1, 3);
    CHECK(face.width() == 13);
    CHECK(octaves(face.pixels(), {chain[1].face(3).row(0), face.pixels().size()}, 1e-7) <
          0.7);  // of noise over three octaves
}

TEST_CASE("uastc_hdr: a block of another kind decodes to black") {
    Bytes16 bytes{};
    std::vector<float> rgb(48, 7.0f);
    decode_uastc_hdr(bytes.data(), 1, rgb.data());
    for (const float v : rgb) CHECK(v == 0);
}

TEST_CASE("uastc_hdr: a photograph keeps 57 dB of log radiance") {
    DOMELIGHT_DATA_FILE(file, "hdr_crops/hdr-rgb-bellparkpier.hdr");
    const auto bytes = FileBytes::open(file, 1 << 30);
    REQUIRE(bytes);
    const auto reader = open_image_reader(*bytes, {});
    REQUIRE(reader);
    ImageF image((*reader)->facts().width, (*reader)->facts().height, 3);
    REQUIRE((*reader)->read(image.view()));
    std::vector<FilteredMap> maps(1);
    maps[0] = {Layout::latlong, image};
    const ImageF back = decode_texture(encode_texture(maps, Encoding::uastc_hdr, 0), 0, 0);
    double mean = 0;
    for (const float v : image.pixels()) mean += v / double(image.pixels().size());
    const auto [low, high] = std::minmax_element(image.pixels().begin(), image.pixels().end());
    const double floor = 1e-4 * mean, range = std::log2((*high + floor) / (*low + floor));
    const double psnr = 20 * std::log10(range / octaves(image.pixels(), back.pixels(), floor));
    CHECK(psnr > 57);  // 57.2; the reference encoder 55.6
}
