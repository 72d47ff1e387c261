#include "domelight/texture/texture.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/container/texture_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

using namespace domelight;
using namespace domelight::test;

TEST_CASE("ktx1: what was written is read back") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx";
    for (Encoding encoding : k_encodings)
        for (int faces : {1, 6})
            for (int levels : {1, 4}) {
                const Texture texture = sample_texture(encoding, 10, faces, levels);
                REQUIRE(write_ktx1(file, texture));
                const auto back = read_texture(file);
                REQUIRE(back);
                CHECK(same_texels(*back, texture));
                CHECK(back->metadata == texture.metadata);
                const auto info = read_texture_info(file);
                REQUIRE(info);
                CHECK(info->container == "KTX");
                CHECK(info->levels == levels);
                CHECK(info->decodable);
            }
}

TEST_CASE("ktx1: imageSize is that of one face, and the file holds nothing else") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx";
    Texture texture = sample_texture(Encoding::r11g11b10f, 8, 6, 2);
    texture.metadata = {{"sh", "1 2 3"}};
    REQUIRE(write_ktx1(file, texture));
    const auto bytes = file_bytes(file);
    const std::size_t pair = 4 + 12;  // "sh" NUL "1 2 3" NUL is 9 bytes, padded to 12
    CHECK(u32_at(bytes, 60) == pair);
    CHECK(u32_at(bytes, 64 + pair) == 8 * 8 * 4);
    CHECK(u32_at(bytes, 64 + pair + 4 + 6 * 8 * 8 * 4) == 4 * 4 * 4);
    CHECK(bytes.size() == 64 + pair + 4 + 6 * 8 * 8 * 4 + 4 + 6 * 4 * 4 * 4);
}

TEST_CASE("ktx1: blocks are announced as compressed and counted in whole ones") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx";
    Texture texture = sample_texture(Encoding::bc6h, 6, 6, 3);
    texture.metadata = {};
    REQUIRE(write_ktx1(file, texture));
    const auto bytes = file_bytes(file);
    // type, type size, format, internal format, base format
    const std::uint32_t expected[] = {0, 1, 0, 0x8e8f, 0x1907};
    for (std::size_t i = 0; i < 5; ++i) CHECK(u32_at(bytes, 16 + 4 * i) == expected[i]);
    CHECK(u32_at(bytes, 64) == 4 * 16);
    CHECK(bytes.size() == 64 + 3 * 4 + 6 * (4 + 1 + 1) * 16);
}

TEST_CASE("ktx1: a file of the other endianness and padded RGB16F rows") {
    // One level of 3 x 1 RGB16F: 18 bytes a row, padded to 20. All numbers big-endian.
    std::vector<std::uint8_t> bytes{0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n', 4, 3, 2, 1};
    const auto big = [&](std::uint32_t v) {
        for (int shift : {24, 16, 8, 0}) bytes.push_back(std::uint8_t(v >> shift));
    };
    for (std::uint32_t v : {0x140bu, 2u, 0x1907u, 0x881bu, 0x1907u, 3u, 1u, 0u, 0u, 1u, 1u, 0u, 20u}) big(v);
    for (int i = 0; i < 10; ++i) {
        const std::uint16_t half = std::uint16_t(0x3c00 + 0x40 * i);  // 1, 1.0625, 1.125, ...
        bytes.push_back(std::uint8_t(half >> 8));
        bytes.push_back(std::uint8_t(half & 255));
    }
    MemorySource source(bytes);
    const auto texture = ktx1_texture(source);
    REQUIRE(texture);
    CHECK(texture->encoding == Encoding::rgba16f);
    CHECK((texture->levels[0][6] | texture->levels[0][7] << 8) == 0x3c00);  // alpha is filled in as 1
    const ImageF image = decode_texture(*texture, 0, 0);
    CHECK(image.at(0, 0)[0] == 1.0f);
    CHECK(image.at(1, 0)[0] == 1.1875f);
    CHECK(image.at(2, 0)[2] == 1.5f);
}

TEST_CASE("ktx1: rows of three bytes a texel are padded, and blocks are not") {
    const auto file = [](std::initializer_list<std::uint32_t> words, std::vector<std::uint8_t> texels) {
        std::vector<std::uint8_t> bytes{0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n'};
        for (std::uint32_t v : words)
            for (int shift : {0, 8, 16, 24}) bytes.push_back(std::uint8_t(v >> shift));
        bytes.insert(bytes.end(), texels.begin(), texels.end());
        return bytes;
    };
    const auto texel = [](const std::vector<std::uint8_t>& bytes, int x, int y) {
        MemorySource source(bytes);
        const auto texture = ktx1_texture(source, Decode::rgbm);  // which returns the bytes unchanged
        REQUIRE_MESSAGE(texture, texture.error().format());
        const std::uint8_t* p = texture->levels[0].data() + 4 * (texture->width * y + x);
        return std::array<int, 4>{p[0], p[1], p[2], p[3]};
    };
    // BGR8 of 3 x 2: 9 bytes a row, padded to 12.
    std::vector<std::uint8_t> rows(24);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = std::uint8_t(i);
    const auto bgr = file({0x04030201, 0x1401, 1, 0x80e0, 0x8051, 0x1907, 3, 2, 0, 0, 1, 1, 0, 24}, rows);
    CHECK(texel(bgr, 1, 1) == std::array<int, 4>{17, 16, 15, 255});
    // BC1 of 6 x 4, two blocks: ends red and blue, rows of indices 0 1 2 3.
    const std::vector<std::uint8_t> blocks{0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4};
    const auto bc1 = file({0x04030201, 0, 1, 0, 0x83f1, 0x1908, 6, 4, 0, 0, 1, 1, 0, 16}, blocks);
    CHECK(texel(bc1, 5, 3) == std::array<int, 4>{0, 0, 255, 255});
}

TEST_CASE("ktx1: truncations and changed headers give one error") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx";
    REQUIRE(write_ktx1(file, sample_texture(Encoding::rgba16f, 4, 6, 3)));
    const auto bytes = file_bytes(file);
    for (std::size_t n = 12; n < bytes.size(); ++n) {
        MemorySource source(std::span<const std::uint8_t>(bytes).first(n));
        const auto texture = ktx1_texture(source);
        REQUIRE(!texture);
        CHECK(!texture.error().what.empty());
    }
    for (std::size_t at = 12; at < 200; ++at)
        for (std::uint8_t change : {0x01, 0x80, 0xff}) {
            auto changed = bytes;
            changed[at] ^= change;
            MemorySource source(changed);
            const auto texture = ktx1_texture(source);
            if (!texture) CHECK(!texture.error().what.empty());
        }
}

TEST_CASE("ktx1: Filament's own files") {
    DOMELIGHT_DATA_FILE(file, "reference/symmetrical_garden/symmetrical_garden_ibl.ktx");
    const auto info = read_texture_info(file);
    REQUIRE(info);
    CHECK(info->format == "GL_R11F_G11F_B10F");
    CHECK(info->levels == 5);
    CHECK(info->width == 256);
    CHECK(info->faces == 6);
    const auto texture = read_texture(file);
    REQUIRE(texture);
    // The first harmonic in its metadata is the mean radiance, and nearly that of the roughest level (texels are not
    // weighed by solid angle here).
    std::istringstream sh(texture->metadata.at("sh"));
    double mean[3];
    sh >> mean[0] >> mean[1] >> mean[2];
    CHECK(mean[0] == doctest::Approx(0.744558));
    double sum[3] = {0, 0, 0};
    for (int face = 0; face < 6; ++face) {
        const ImageF image = decode_texture(*texture, 4, face);
        for (int i = 0; i < 256; ++i)
            for (int c = 0; c < 3; ++c) sum[c] += image.pixels()[std::size_t(3 * i + c)] / 1536;
    }
    for (int c = 0; c < 3; ++c) CHECK(sum[c] == doctest::Approx(mean[c]).epsilon(0.1));
    // The skybox of the same environment: every value finite, not negative.
    DOMELIGHT_DATA_FILE(skybox, "reference/symmetrical_garden/symmetrical_garden_skybox.ktx");
    const auto sky = read_texture(skybox);
    REQUIRE(sky);
    for (int face = 0; face < 6; ++face) {
        const ImageF image = decode_texture(*sky, 0, face);
        for (float v : image.pixels()) REQUIRE((std::isfinite(v) && v >= 0));
    }
}
