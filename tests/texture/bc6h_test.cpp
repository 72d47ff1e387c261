#include "texture/block/bc6h.h"

#include "domelight/compare/picture_reader.h"
#include "domelight/texture/texture.h"

#include "base/instruction_set.h"
#include "test.h"
#include "texture/block/bc6h_encode.h"
#include "texture/block/bc6h_encode_simd.h"
#include "texture/texel/half.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

using namespace domelight;
using namespace domelight::test;

namespace {

using Block = std::array<std::uint8_t, 16>;

float noise(std::uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) * 0x1p-24f;
}

Block random_block(std::uint32_t& state) {
    Block block;
    for (auto& byte : block) byte = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
    return block;
}

std::vector<float> decoded(const std::vector<std::uint8_t>& blocks) {
    std::vector<float> texels(blocks.size() * 3);
    for (std::size_t i = 0; i < blocks.size() / 16; ++i) bc6h::decode(blocks.data() + 16 * i, texels.data() + 48 * i);
    return texels;
}

std::vector<std::uint8_t> encoded(const std::vector<float>& texels, EncodingQuality quality) {
    std::vector<std::uint8_t> blocks(texels.size() / 3);
    simd::bc6h_encode(texels.data(), int(texels.size() / 48), quality, blocks.data());
    return blocks;
}

/// Sum of the squared differences of the bits of half floats, which the encoder minimises.
double bit_error(const float* a, const float* b, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const double d = double(half_from_float(a[i])) - double(half_from_float(b[i]));
        sum += d * d;
    }
    return sum;
}

/// Blocks of many kinds: flat, sloped, two colours, rough, over any range of brightness.
std::vector<float> many_blocks(int count, std::uint32_t seed) {
    std::vector<float> texels;
    std::uint32_t state = seed;
    for (int b = 0; b < count; ++b) {
        const int kind = b % 5;
        float base[3], slope_x[3], slope_y[3], other[3];
        const float brightness = 24 * noise(state) - 12, spread = std::exp2(4 * noise(state) - 4);
        for (int c = 0; c < 3; ++c) {
            base[c] = brightness + noise(state);
            slope_x[c] = spread * (noise(state) - 0.5f);
            slope_y[c] = spread * (noise(state) - 0.5f);
            other[c] = base[c] + 6 * (noise(state) - 0.5f);
        }
        const unsigned partition = bc6h::k_partition[std::size_t(noise(state) * 31.99f)];
        for (int t = 0; t < 16; ++t)
            for (int c = 0; c < 3; ++c) {
                float stops = base[c];
                if (kind >= 1) stops += slope_x[c] * float(t % 4) + slope_y[c] * float(t / 4);
                if (kind >= 2 && (partition >> t & 1u)) stops = other[c];
                if (kind >= 3) stops += 0.1f * spread * noise(state);
                if (kind == 4) stops = brightness + 8 * noise(state);
                texels.push_back(std::clamp(std::exp2(stops), 0.0f, 65504.0f));
            }
    }
    return texels;
}

/// Every `step`-th block of a picture, side by side.
ImageF block_strip(const ImageF& picture, int step) {
    const int columns = picture.width() / 4, blocks = columns * (picture.height() / 4),
              count = (blocks + step - 1) / step;
    ImageF strip(4 * count, 4, 3);
    for (int i = 0; i < count; ++i)
        for (int y = 0; y < 4; ++y)
            std::copy_n(picture.at(i * step % columns * 4, i * step / columns * 4 + y), 12, strip.at(4 * i, y));
    return strip;
}

}  // namespace

TEST_CASE("bc6h: random blocks of every mode decode as by an independent decoder") {
    // 4096 blocks of all fourteen modes and the four reserved ones; the hash is that of what bcdec, by way of
    // OpenImageIO 3.2, makes of them.
    std::uint32_t state = 12345;
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 4096; ++i) {
        Block block = random_block(state);
        block[0] = std::uint8_t((block[0] & 0xe0) | (i & 31));
        bc6h::HalfTexels texels;
        bc6h::decode(block.data(), texels);
        for (const auto& texel : texels)
            for (const std::uint16_t v : texel) hash = (hash ^ v) * 0x100000001b3u;
    }
    CHECK(hash == 0xc478c3a47a5083f5u);
}

TEST_CASE("bc6h: every value that decodes is a finite half, and packing undoes unpacking") {
    std::uint32_t state = 1;
    int reserved = 0;
    for (int i = 0; i < 20000; ++i) {
        const Block block = random_block(state);
        bc6h::HalfTexels texels;
        bc6h::decode(block.data(), texels);
        for (const auto& texel : texels)
            for (const std::uint16_t v : texel) REQUIRE(v <= 0x7bff);
        bc6h::Fields fields;
        if (!bc6h::unpack(block.data(), fields)) {
            ++reserved;
            for (const auto& texel : texels)
                for (const std::uint16_t v : texel) REQUIRE(v == 0);
            continue;
        }
        Block again;
        bc6h::pack(fields, again.data());
        REQUIRE(again == block);
    }
    CHECK(reserved > 2000);  // four of 32 codes
}

TEST_CASE("bc6h: a block by hand") {
    // Mode 11 (code 3): ends of 10 bits (1023, 0, 512) and (0, 0, 512), indices 0 and 15 alternating.
    bc6h::Fields fields;
    fields.mode = 10;
    fields.endpoint[0] = {1023, 0, 512};
    fields.endpoint[1] = {0, 0, 512};
    for (std::size_t t = 0; t < 16; ++t) fields.index[t] = t % 2 ? 15 : 0;
    Block block;
    bc6h::pack(fields, block.data());
    CHECK((block[0] & 31) == 3);
    CHECK(((block[0] >> 5 | block[1] << 3) & 1023) == 1023);  // red of the first end, bits 5 to 14
    CHECK((block[8] & 0xfe) == 0xf0);                         // indices from bit 65: three bits 000, then 1111
    float rgb[48];
    bc6h::decode(block.data(), rgb);
    CHECK(rgb[0] == 65504);
    CHECK(rgb[1] == 0);
    CHECK(rgb[3] == 0);
    // 512 of 10 bits is 32800 of 16, times 31/64 is 15887 = 0x3e0f, 1 + 527/1024.
    CHECK(rgb[2] == 1 + 527.0f / 1024);
    CHECK(rgb[47] == rgb[2]);
}

TEST_CASE("bc6h: the plain encoder and every instruction set give the same bytes") {
    const struct {
        EncodingQuality quality;
        int blocks;
    } cases[] = {{EncodingQuality::fast, 300}, {EncodingQuality::standard, 60}, {EncodingQuality::high, 6}};
    for (const auto& [quality, count] : cases) {
        const std::vector<float> texels = many_blocks(count, 5);
        std::vector<std::uint8_t> plain(std::size_t(16 * count));
        bc6h::encode_plain(texels.data(), count, quality, plain.data());
        for (const char* set : {"AVX3", "AVX2", "SSE4", "SCALAR"}) {
            simd::limit_instruction_set(set);
            CAPTURE(simd::instruction_set());
            CHECK(encoded(texels, quality) == plain);
            // A block does not depend on its neighbours in the vector.
            std::vector<std::uint8_t> alone(16);
            simd::bc6h_encode(texels.data() + 48 * 3, 1, quality, alone.data());
            CHECK(std::equal(alone.begin(), alone.end(), plain.begin() + 48));
        }
        simd::limit_instruction_set("");
    }
}

TEST_CASE("bc6h: flat blocks come back exactly") {
    std::vector<float> texels;
    std::uint32_t state = 4;
    for (int i = 0; i < 2000; ++i) {
        const std::uint16_t half[3] = {std::uint16_t(noise(state) * 31743.99f), std::uint16_t(i == 1 ? 31743 : i * 7),
                                       std::uint16_t(i < 2 ? 31743 * i : noise(state) * 31743.99f)};
        for (int t = 0; t < 16; ++t)
            for (const std::uint16_t h : half) texels.push_back(float_from_half(h));
    }
    for (const EncodingQuality quality : {EncodingQuality::fast, EncodingQuality::standard})
        CHECK(decoded(encoded(texels, quality)) == texels);
}

TEST_CASE("bc6h: each quality is at least as good as the one below, and no worse than one colour") {
    const int compared = 80;
    std::vector<double> total;
    for (const EncodingQuality quality : {EncodingQuality::fast, EncodingQuality::standard, EncodingQuality::high}) {
        const int count = quality == EncodingQuality::high ? compared : 4000;
        const std::vector<float> texels = many_blocks(count, 9), back = decoded(encoded(texels, quality));
        total.push_back(bit_error(texels.data(), back.data(), compared * 48));
        for (int b = 0; b < count; ++b) {
            // Mode 14 can represent a single colour, the mean of the bits.
            double flat = 0;
            for (int c = 0; c < 3; ++c) {
                double mean = 0, square = 0;
                for (int t = 0; t < 16; ++t) {
                    const double h = half_from_float(texels[std::size_t(48 * b + 3 * t + c)]);
                    mean += h / 16;
                    square += h * h;
                }
                flat += square - 16 * mean * mean;
            }
            CHECK(bit_error(texels.data() + 48 * b, back.data() + 48 * b, 48) <= flat * 1.001 + 16);
        }
    }
    CHECK(total[1] < total[0]);
    CHECK(total[2] < total[1]);
}

TEST_CASE("bc6h: two colours along any partition are nearly exact") {
    std::vector<float> texels;
    for (const unsigned partition : bc6h::k_partition)
        for (int t = 0; t < 16; ++t)
            for (const float v : partition >> t & 1u ? std::array{8.0f, 0.25f, 1.0f} : std::array{0.5f, 2.0f, 1.0f})
                texels.push_back(v);
    const std::vector<float> back = decoded(encoded(texels, EncodingQuality::standard));
    for (std::size_t i = 0; i < texels.size(); ++i)
        CHECK(std::abs(back[i] / texels[i] - 1) < 0.02f);  // two ends of one line, 6 bits and more
}

TEST_CASE("bc6h: texels on any line of colours, up or down in each channel, are nearly exact") {
    std::uint32_t state = 21;
    std::vector<float> texels;
    constexpr int k_lines = 200;
    for (int i = 0; i < k_lines; ++i) {
        // In half floats' bits, which the format interpolates: 16 even steps over up to two stops, in any order; the
        // channels' changes add up to nothing, so that no fixed direction would fit.
        float middle[3], span[3];
        for (int c = 0; c < 3; ++c) middle[c] = 8000 + 12000 * noise(state), span[c] = 2000 * (noise(state) - 0.5f);
        span[2] = -span[0] - span[1];
        for (int t = 0; t < 16; ++t)
            for (int c = 0; c < 3; ++c)
                texels.push_back(
                    float_from_half(std::uint16_t(middle[c] + span[c] * float(t * (2 * i + 1) % 16) / 15)));
    }
    for (const EncodingQuality quality : {EncodingQuality::fast, EncodingQuality::standard}) {
        const std::vector<float> back = decoded(encoded(texels, quality));
        const double rms = std::sqrt(bit_error(texels.data(), back.data(), 48 * k_lines) / (48 * k_lines));
        // Ends of 11 bits are off by up to 8 of these bits, of 12 bits by up to 4.
        CHECK(rms < 4.5);
    }
}

TEST_CASE("bc6h: a sun of one texel in the dark keeps its brightness") {
    std::vector<float> texels(48, 0.01f);
    for (int c = 0; c < 3; ++c) texels[std::size_t(15 + c)] = 65504;
    for (const EncodingQuality quality : {EncodingQuality::fast, EncodingQuality::standard}) {
        const std::vector<float> back = decoded(encoded(texels, quality));
        CHECK(back[15] == doctest::Approx(65504).epsilon(0.02));
        CHECK(back[0] == doctest::Approx(0.01).epsilon(0.1));
    }
}

TEST_CASE("bc6h: textures of any size, what is out of range clipped and counted") {
    for (const auto& [width, height] : {std::array{1, 1}, std::array{2, 2}, std::array{10, 5}, std::array{13, 7}}) {
        std::vector<FilteredMap> chain(1);
        chain[0] = {Layout::latlong, ImageF(width, height, 3)};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c)
                    chain[0].image.at(x, y)[c] = std::exp2(0.1f * float(x) - 0.2f * float(y) + 0.3f * float(c));
        float* corner = chain[0].image.at(width - 1, height - 1);
        corner[0] = 1e6f;
        corner[1] = -1;
        corner[2] = std::numeric_limits<float>::quiet_NaN();
        std::vector<EncodingReport> reports;
        const Texture texture = encode_texture(chain, Encoding::bc6h, 2, &reports);
        CHECK(texture.levels[0].size() == std::size_t((width + 3) / 4 * ((height + 3) / 4) * 16));
        CHECK(reports[0].clipped_texels == 1);
        CHECK(reports[0].clipped_energy > 0);
        const ImageF back = decode_texture(texture, 0, 0);
        REQUIRE(back.width() == width);
        REQUIRE(back.height() == height);
        for (const float v : back.pixels()) REQUIRE((v >= 0 && v <= 65504));
        if (width * height > 1) CHECK(back.at(0, 0)[0] == doctest::Approx(1).epsilon(0.1));
    }
}

TEST_CASE("bc6h: real environments, the default within half a decibel of the exhaustive search") {
    // Some blocks from all over each environment, as one strip.
    for (const char* name : {"env_latlong/studio_small_03_1k.hdr", "env_latlong/blocky_photo_studio_1k.hdr",
                             "env_latlong/forest_slope_1k.hdr"}) {
        const auto data = data_folder();
        if (!data || !std::filesystem::exists(*data / name)) return note_skip("DOMELIGHT_DATA has no env_latlong");
        const auto picture = read_picture(*data / name);
        REQUIRE(picture);
        std::vector<FilteredMap> strip(1);
        strip[0] = {Layout::latlong, block_strip(picture->rgb, 557)};
        std::vector<EncodingReport> reports;
        const auto psnr = [&](EncodingQuality quality) {
            encode_texture(strip, Encoding::bc6h, 1, &reports, quality);
            return reports[0].log_psnr;
        };
        const double fast = psnr(EncodingQuality::fast), standard = psnr(EncodingQuality::standard),
                     high = psnr(EncodingQuality::high), best = psnr(EncodingQuality::exhaustive);
        INFO(std::string(name));
        CHECK(standard > best - 0.5);
        CHECK(high > best - 0.3);
        CHECK(fast > best - 6);
        CHECK(fast > 40);
    }
}
