#include "domelight/texture/texture.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/block/bc7.h"
#include "texture/container/texture_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

using namespace domelight;
using namespace domelight::test;

TEST_CASE("dds: what was written is read back") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    for (Encoding encoding : k_encodings)
        for (int faces : {1, 6})
            for (int levels : {1, 4}) {
                const Texture texture = sample_texture(encoding, 10, faces, levels);
                REQUIRE(write_dds(file, texture));
                const auto back = read_texture(file);
                REQUIRE(back);
                CHECK(same_texels(*back, texture));
                const auto info = read_texture_info(file);
                REQUIRE(info);
                CHECK(info->container == "DDS");
                CHECK(info->levels == levels);
                CHECK(info->faces == faces);
                CHECK(info->decodable);
            }
}

TEST_CASE("dds: faces one after the other, each with all its levels") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    const Texture texture = sample_texture(Encoding::rgba16f, 4, 6, 3);
    REQUIRE(write_dds(file, texture));
    const auto bytes = file_bytes(file);
    CHECK(u32_at(bytes, 128) == 10);  // DXGI_FORMAT_R16G16B16A16_FLOAT
    CHECK(u32_at(bytes, 136) == 4);   // cube
    CHECK(u32_at(bytes, 140) == 1);   // one of it
    CHECK((u32_at(bytes, 112) & 0xfe00) == 0xfe00);
    std::size_t at = 148;
    for (std::size_t face = 0; face < 6; ++face)
        for (const auto& level : texture.levels) {
            const std::size_t size = level.size() / 6;
            CHECK(std::memcmp(bytes.data() + at, level.data() + face * size, size) == 0);
            at += size;
        }
    CHECK(at == bytes.size());
}

TEST_CASE("dds: blocks state the size of the finest level, and every level has at least one") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    const Texture texture = sample_texture(Encoding::bc6h, 10, 6, 4);
    CHECK(texture.levels[0].size() == 6 * 9 * 16);
    CHECK(texture.levels[1].size() == 6 * 4 * 16);
    CHECK(texture.levels[3].size() == 6 * 16);
    REQUIRE(write_dds(file, texture));
    const auto bytes = file_bytes(file);
    CHECK(u32_at(bytes, 128) == 95);     // DXGI_FORMAT_BC6H_UF16
    CHECK(u32_at(bytes, 20) == 9 * 16);  // linear size
    CHECK((u32_at(bytes, 8) & 0x80008) == 0x80000);
    CHECK(bytes.size() == 148 + 6 * (9 + 4 + 1 + 1) * 16);
}

TEST_CASE("dds: truncations and changed headers give one error") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    REQUIRE(write_dds(file, sample_texture(Encoding::rgb9e5, 4, 6, 3)));
    const auto bytes = file_bytes(file);
    for (std::size_t n = 4; n < bytes.size(); ++n) {
        MemorySource source(std::span<const std::uint8_t>(bytes).first(n));
        const auto texture = dds_texture(source);
        REQUIRE(!texture);
        CHECK(!texture.error().what.empty());
    }
    for (std::size_t at = 4; at < 148; ++at)
        for (std::uint8_t change : {0x01, 0x80, 0xff}) {
            auto changed = bytes;
            changed[at] ^= change;
            MemorySource source(changed);
            const auto texture = dds_texture(source);
            if (!texture) CHECK(!texture.error().what.empty());
        }
}

TEST_CASE("dds: a cube of single half channels by another writer") {
    DOMELIGHT_DATA_FILE(file, "env_projections/dxt10-r16f-cube.dds");
    const auto texture = read_texture(file);
    REQUIRE(texture);
    CHECK(texture->encoding == Encoding::rg16f);
    CHECK(texture->faces == 6);
    CHECK(texture->width == 2);
    // Texels are de ad ca fe ... : red as stored, green zero.
    CHECK(texture->levels[0][0] == 0xde);
    CHECK(texture->levels[0][1] == 0xad);
    CHECK(texture->levels[0][2] == 0);
    CHECK(texture->levels[0][4] == 0xca);
}

TEST_CASE("dds: formats of other tools are named") {
    const auto named = [](const char* relative, const char* format, int faces, int levels) {
        DOMELIGHT_DATA_FILE(file, "env_projections/dxt10-r16f-cube.dds");
        const auto info = read_texture_info(file.parent_path() / relative);
        REQUIRE(info);
        CHECK(info->format == format);
        CHECK(info->faces == faces);
        CHECK(info->levels == levels);
    };
    named("dxt1-cube-mips.dds", "DXT1", 6, 3);
    named("dxt10-bc7-cube-mips.dds", "DXGI_FORMAT_BC7_UNORM", 6, 3);
    named("dxt10-r8snorm-cube-array.dds", "DXGI_FORMAT_R8_SNORM", 6, 1);
}

TEST_CASE("dds: odd and hostile files give a result or one error") {
    const auto data = data_folder();
    if (!data || !std::filesystem::exists(*data / "malformed/dds_magnum"))
        return note_skip("DOMELIGHT_DATA has no malformed/dds_magnum");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(*data / "malformed/dds_magnum"))
        files.push_back(entry.path());
    for (const auto& entry : std::filesystem::directory_iterator(*data / "malformed/oiio"))
        if (entry.path().extension() == ".dds") files.push_back(entry.path());
    CHECK(files.size() >= 29);
    for (const auto& file : files) {
        const auto info = read_texture_info(file);
        const auto texture = read_texture(file);
        if (info)
            CHECK(info->decodable == bool(texture));
        else {
            CHECK(info.error().where == file.string());
            CHECK(!texture);
        }
    }
    CHECK(!read_texture_info(*data / "malformed/oiio/crash-bomb-32768.dds"));
    const auto volume = read_texture_info(*data / "malformed/dds_magnum/dxt10-bc7-3d.dds");
    REQUIRE(volume);
    CHECK(volume->depth > 0);
}

TEST_CASE("dds: the header from before DX10 says the same of the texels it knows") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    for (const Encoding encoding : {Encoding::rgba16f, Encoding::rgba32f, Encoding::rg16f, Encoding::rg32f})
        for (const int faces : {1, 6}) {
            const Texture texture = sample_texture(encoding, 8, faces, 3);
            REQUIRE(write_dds9(file, texture));
            const auto bytes = file_bytes(file);
            CHECK(u32_at(bytes, 84) != 0x30315844);
            CHECK(bytes.size() == 128 + texture.levels[0].size() + texture.levels[1].size() + texture.levels[2].size());
            const auto back = read_texture(file);
            REQUIRE(back);
            CHECK(same_texels(*back, texture));
        }
    CHECK_FALSE(write_dds9(file, sample_texture(Encoding::rgb9e5, 8, 6, 1)));
    CHECK_FALSE(write_dds9(file, sample_texture(Encoding::bc6h, 8, 6, 1)));
}

TEST_CASE("dds: RGBM and its like are RGBA bytes, which mean what one says they do") {
    const TemporaryFolder folder;
    const auto file = folder / "a.dds";
    for (const Encoding encoding : k_scaled_bytes) {
        const Texture texture = sample_texture(encoding, 8, 6, 3);
        REQUIRE(write_dds9(file, texture));
        const auto info = read_texture_info(file);
        REQUIRE(info);
        CHECK(info->format == "RGBA 32 bit");
        CHECK(info->eight_bits);
        CHECK(info->decodable);
        const auto back = read_texture(file, *from_name<Decode>(name_of(encoding)));
        REQUIRE(back);
        CHECK(same_texels(*back, texture));
        const auto screen = read_texture(file);  // sRGB if the file states nothing
        REQUIRE(screen);
        CHECK(screen->encoding == Encoding::rgba16f);
        const std::uint8_t red = texture.levels[1][4];
        const double v = red / 255.0;
        CHECK(decode_texture(*screen, 1, 0).at(1, 0)[0] ==
              doctest::Approx(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)).epsilon(1e-3));
    }
}

namespace {

/// A header from before DX10, 4 x 4 texels, with the pixel format's words from its flags on.
std::vector<std::uint8_t> old_dds(const std::array<std::uint32_t, 7>& pixel_format,
                                  const std::vector<std::uint8_t>& texels, std::uint32_t caps2 = 0) {
    std::vector<std::uint8_t> bytes(128 + texels.size());
    const auto put = [&](std::size_t at, std::uint32_t v) { std::memcpy(bytes.data() + at, &v, 4); };
    put(0, 0x20534444);
    put(4, 124);
    put(8, 0x1007);
    put(12, 4);
    put(16, 4);
    put(28, 1);
    put(76, 32);
    for (std::size_t i = 0; i < 7; ++i) put(80 + 4 * i, pixel_format[i]);
    put(108, 0x1000);
    put(112, caps2);
    std::copy(texels.begin(), texels.end(), bytes.begin() + 128);
    return bytes;
}

/// Texel (x, y) as 8-bit numbers.
std::array<int, 4> screen_texel(const std::vector<std::uint8_t>& bytes, int x, int y) {
    MemorySource source(bytes);
    const auto texture = dds_texture(source, Decode::rgbm);  // which returns the bytes unchanged
    REQUIRE(texture);
    const std::uint8_t* p = texture->levels[0].data() + 4 * (4 * y + x);
    return {p[0], p[1], p[2], p[3]};
}

}  // namespace

TEST_CASE("dds: eight bits a channel in the orders of old games") {
    using Texel = std::array<int, 4>;
    std::vector<std::uint8_t> texels(64);
    for (std::size_t i = 0; i < 64; ++i) texels[i] = std::uint8_t(i);
    // Texel (2, 1) is number 6: bytes 24 to 27.
    const auto bgra = old_dds({0x41, 0, 32, 0xff0000, 0xff00, 0xff, 0xff000000}, texels);
    CHECK(screen_texel(bgra, 2, 1) == Texel{26, 25, 24, 27});
    const auto bgrx = old_dds({0x40, 0, 32, 0xff0000, 0xff00, 0xff, 0}, texels);
    CHECK(screen_texel(bgrx, 2, 1) == Texel{26, 25, 24, 255});
    const auto bgr = old_dds({0x40, 0, 24, 0xff0000, 0xff00, 0xff, 0}, texels);
    CHECK(screen_texel(bgr, 2, 1) == Texel{20, 19, 18, 255});
    const auto grey = old_dds({0x20000, 0, 8, 0xff, 0, 0, 0}, texels);
    CHECK(screen_texel(grey, 2, 1) == Texel{6, 6, 6, 255});
    const auto rgb565 = old_dds({0x40, 0, 16, 0xf800, 0x7e0, 0x1f, 0}, texels);
    MemorySource source(rgb565);
    const auto refused = dds_texture(source);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("cannot decode") != std::string::npos);
}

TEST_CASE("dds: BC1, BC2 and BC3 decode as Direct3D documents them") {
    using Texel = std::array<int, 4>;
    // Ends red (31, 0, 0) and blue (0, 0, 31) of 5, 6 and 5 bits; rows of indices 0 1 2 3.
    const std::vector<std::uint8_t> colours{0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4};
    const auto bc1 = old_dds({0x4, 0x31545844, 0, 0, 0, 0, 0}, colours);
    CHECK(screen_texel(bc1, 0, 0) == Texel{255, 0, 0, 255});
    CHECK(screen_texel(bc1, 1, 2) == Texel{0, 0, 255, 255});
    CHECK(screen_texel(bc1, 2, 3) == Texel{170, 0, 85, 255});
    CHECK(screen_texel(bc1, 3, 1) == Texel{85, 0, 170, 255});
    // The other order of the ends: one colour between, and nothing.
    const std::vector<std::uint8_t> three{0x1f, 0x00, 0x00, 0xf8, 0xe4, 0xe4, 0xe4, 0xe4};
    const auto punched = old_dds({0x4, 0x31545844, 0, 0, 0, 0, 0}, three);
    CHECK(screen_texel(punched, 2, 0) == Texel{128, 0, 128, 255});
    CHECK(screen_texel(punched, 3, 0) == Texel{0, 0, 0, 0});
    std::vector<std::uint8_t> bc2_block{0x10, 0x32, 0x54, 0x76, 0x98, 0xba, 0xdc, 0xfe};
    bc2_block.insert(bc2_block.end(), three.begin(), three.end());
    const auto bc2 = old_dds({0x4, 0x33545844, 0, 0, 0, 0, 0}, bc2_block);
    CHECK(screen_texel(bc2, 3, 0) == Texel{170, 0, 85, 3 * 17});  // four colours whatever the order
    CHECK(screen_texel(bc2, 1, 3) == Texel{255, 0, 0, 13 * 17});
    // Alpha from 200 to 60, indices 0 to 7 in the first two rows: 24 bits, lowest first.
    std::vector<std::uint8_t> bc3_block{200, 60, 0x88, 0xc6, 0xfa, 0x88, 0xc6, 0xfa};
    bc3_block.insert(bc3_block.end(), colours.begin(), colours.end());
    const auto bc3 = old_dds({0x4, 0x35545844, 0, 0, 0, 0, 0}, bc3_block);
    CHECK(screen_texel(bc3, 0, 0)[3] == 200);
    CHECK(screen_texel(bc3, 1, 0)[3] == 60);
    CHECK(screen_texel(bc3, 2, 0)[3] == 180);
    CHECK(screen_texel(bc3, 3, 1)[3] == 80);
}

// Each mode with each partition, and bits of all kinds. The hash and the texels are those of Pillow 13's decoder.
TEST_CASE("bc7: blocks of all modes decode as by another decoder") {
    const std::array<std::array<int, 4>, 8> last{{{0, 0, 99, 255},
                                                  {191, 215, 199, 255},
                                                  {211, 38, 122, 255},
                                                  {132, 126, 80, 255},
                                                  {206, 66, 24, 247},
                                                  {86, 140, 229, 248},
                                                  {44, 41, 131, 38},
                                                  {203, 80, 194, 122}}};
    std::uint32_t random = 1, hash = 2166136261u;
    for (unsigned k = 0; k < 4096; ++k) {
        std::array<std::uint8_t, 16> block;
        for (std::size_t word = 0; word < 4; ++word) {
            random ^= random << 13, random ^= random >> 17, random ^= random << 5;
            for (std::size_t byte = 0; byte < 4; ++byte) block[4 * word + byte] = std::uint8_t(random >> 8 * byte);
        }
        const unsigned mode = k % 8;
        block[0] = std::uint8_t((block[0] & ~((2u << mode) - 1)) | 1u << mode);
        const Rgba8Block texels = decode_bc7(block.data());
        for (std::size_t c = 0; k < 8 && c < 4; ++c) CHECK(texels[15][c] == last[mode][c]);
        for (const auto& texel : texels)
            for (const std::uint8_t v : texel) hash = (hash ^ v) * 16777619u;
    }
    CHECK(hash == 0xbf7ac2ebu);
    const std::array<std::uint8_t, 16> reserved{0, 255, 255};
    CHECK(decode_bc7(reserved.data())[5] == std::array<std::uint8_t, 4>{});
}

TEST_CASE("dds: a cube without all of its faces says which are missing") {
    const auto bytes = old_dds({0x41, 0, 32, 0xff, 0xff00, 0xff0000, 0xff000000}, std::vector<std::uint8_t>(6 * 64),
                               0x200u | (0xfc00u ^ 0x2000u ^ 0x400u));
    MemorySource source(bytes);
    const auto info = dds_info(source);
    REQUIRE_FALSE(info);
    CHECK(info.error().what == "is a cube of 4 faces, not 6");
    CHECK(info.error().hint == "It lacks +X -Y.");
}
