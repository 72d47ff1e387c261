#include "domelight/texture/texture.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/container/texture_reading.h"
#include "texture/container/vulkan_formats.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace domelight;
using namespace domelight::test;

namespace {

std::uint32_t u32(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return u32_at(bytes, at);
}
std::uint64_t u64(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return u64_at(bytes, at);
}

void set_u32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[at + std::size_t(i)] = std::uint8_t(value >> 8 * i);
}

}  // namespace

TEST_CASE("ktx2: what was written is read back, for every encoding, shape and compression") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx2";
    for (Encoding encoding : k_encodings)
        for (int faces : {1, 6})
            for (int levels : {1, 4})
                for (Supercompression compression : {Supercompression::none, Supercompression::zstd}) {
                    const Texture texture = sample_texture(encoding, 10, faces, levels);
                    REQUIRE(write_ktx2(file, texture, compression));
                    const auto back = read_texture(file);
                    REQUIRE(back);
                    CHECK(same_texels(*back, texture));
                    const auto info = read_texture_info(file);
                    REQUIRE(info);
                    CHECK(info->container == "KTX2");
                    CHECK(info->decodable);
                    CHECK(info->width == 10);
                    CHECK(info->faces == faces);
                    CHECK(info->levels == levels);
                    CHECK(info->supercompression == (compression == Supercompression::zstd ? "zstd" : "none"));
                    for (const auto& [key, value] : texture.metadata) CHECK(info->metadata.at(key) == value);
                    CHECK(info->metadata.at("KTXorientation") == "rd");
                    CHECK(info->metadata.at("KTXwriter").starts_with("Domelight"));
                }
}

TEST_CASE("ktx: scaled bytes are told apart by a key, which the reader takes away again") {
    const TemporaryFolder folder;
    for (Encoding encoding : k_scaled_bytes) {
        const Texture texture = sample_texture(encoding, 6, 6, 2);
        REQUIRE(write_ktx2(folder / "a.ktx2", texture));
        REQUIRE(write_ktx1(folder / "a.ktx", texture));
        for (const char* name : {"a.ktx2", "a.ktx"}) {
            const auto back = read_texture(folder / name);
            REQUIRE(back);
            CHECK(same_texels(*back, texture));
            CHECK(!back->metadata.contains("domelight.encoding"));
            const auto info = read_texture_info(folder / name);
            REQUIRE(info);
            CHECK(info->decodable);
            CHECK(info->format.ends_with(", " + name_of(encoding)));
        }
    }
}

TEST_CASE("ktx2: levels lie aligned, smallest first, key/value data sorted") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx2";
    for (Encoding encoding : k_encodings) {
        const Texture texture = sample_texture(encoding, 16, 6, 5);
        REQUIRE(write_ktx2(file, texture));
        const auto bytes = file_bytes(file);
        std::uint64_t previous = bytes.size();
        for (std::size_t l = 0; l < 5; ++l) {
            const std::uint64_t offset = u64(bytes, 80 + 24 * l), length = u64(bytes, 80 + 24 * l + 8);
            CHECK(offset % std::uint64_t(encoding_bytes(encoding)) == 0);
            CHECK(length == texture.levels[l].size());
            CHECK(u64(bytes, 80 + 24 * l + 16) == length);
            CHECK(offset + length <= previous);
            CHECK(previous - (offset + length) < std::uint64_t(encoding_bytes(encoding)));  // only padding between
            CHECK(std::memcmp(bytes.data() + offset, texture.levels[l].data(), length) == 0);
            previous = offset;
        }
        CHECK(u32(bytes, 48) == 80 + 24 * 5);                      // descriptor right behind the index
        CHECK(u32(bytes, 56) == u32(bytes, 48) + u32(bytes, 52));  // key/value data right behind it
        std::string last;
        for (std::size_t at = u32(bytes, 56); at < u32(bytes, 56) + u32(bytes, 60);
             at += (4 + u32(bytes, at) + 3) / 4 * 4) {
            const std::string key = reinterpret_cast<const char*>(bytes.data() + at + 4);
            CHECK(last < key);
            last = key;
        }
    }
}

TEST_CASE("ktx2: the data format descriptors, word for word") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx2";
    const auto descriptor = [&](Encoding encoding) {
        REQUIRE(write_ktx2(file, sample_texture(encoding, 4, 1, 1)));
        const auto bytes = file_bytes(file);
        std::vector<std::uint32_t> words;
        for (std::size_t i = 0; i < u32(bytes, 52); i += 4) words.push_back(u32(bytes, u32(bytes, 48) + i));
        return words;
    };
    using Words = std::vector<std::uint32_t>;
    // Total size; vendor and type; version 2 and block size; RGBSDA, BT.709, linear; texel block; bytes of plane 0;
    // planes 4-7; then samples of {offset, length - 1, channel and qualifiers}, position, lower, upper.
    CHECK(descriptor(Encoding::rg16f) == Words{60, 0, 2 | 56 << 16, 0x00010101, 0, 4, 0, 0xc00f0000, 0, 0xbf800000,
                                               0x3f800000, 0xc10f0010, 0, 0xbf800000, 0x3f800000});
    CHECK(descriptor(Encoding::rgba32f)[5] == 16);
    CHECK(descriptor(Encoding::rgba32f)[19] == 0xcf1f0060);
    CHECK(descriptor(Encoding::r11g11b10f) == Words{76, 0, 2 | 72 << 16, 0x00010101, 0, 4, 0, 0x800a0000, 0, 0,
                                                    0x3f800000, 0x810a000b, 0, 0, 0x3f800000, 0x82090016, 0, 0,
                                                    0x3f800000});
    CHECK(descriptor(Encoding::rgbd) == Words{92, 0, 2 | 88 << 16, 0x00010101, 0, 4, 0,   0x00070000,
                                              0,  0, 255,          0x01070008, 0, 0, 255, 0x02070010,
                                              0,  0, 255,          0x0f070018, 0, 0, 255});
    // Block-compressed: the model's own number, 4 x 4 texels, 16 bytes, one sample of 128 bits.
    CHECK(descriptor(Encoding::bc6h) ==
          Words{44, 0, 2 | 40 << 16, 0x00010185, 0x0303, 16, 0, 0x807f0000, 0, 0, 0x3f800000});
    CHECK(descriptor(Encoding::rgb9e5) ==
          Words{124, 0, 2 | 120 << 16, 0x00010101, 0, 4,  0,  0x00080000, 0, 0, 8448, 0x2004001b, 0, 15, 31, 0x01080009,
                0,   0, 8448,          0x2104001b, 0, 15, 31, 0x02080012, 0, 0, 8448, 0x2204001b, 0, 15, 31});
}

TEST_CASE("ktx2: writing is deterministic and foreign reserved keys are not passed on") {
    const TemporaryFolder folder;
    Texture texture = sample_texture(Encoding::rgb9e5, 8, 6, 3);
    texture.metadata["KTXorientation"] = "S=r,T=d";
    texture.metadata["KTXswizzle"] = "rrr1";
    for (Supercompression compression : {Supercompression::none, Supercompression::zstd}) {
        REQUIRE(write_ktx2(folder / "a.ktx2", texture, compression));
        REQUIRE(write_ktx2(folder / "b.ktx2", texture, compression));
        CHECK(file_bytes(folder / "a.ktx2") == file_bytes(folder / "b.ktx2"));
    }
    const auto info = read_texture_info(folder / "a.ktx2");
    REQUIRE(info);
    CHECK(info->metadata.at("KTXorientation") == "rd");
    CHECK(!info->metadata.contains("KTXswizzle"));
}

TEST_CASE("ktx2: every truncation and every changed byte of the head gives a result or one error") {
    const TemporaryFolder folder;
    for (Supercompression compression : {Supercompression::none, Supercompression::zstd}) {
        const auto file = folder / "a.ktx2";
        REQUIRE(write_ktx2(file, sample_texture(Encoding::r11g11b10f, 4, 6, 3), compression));
        const auto bytes = file_bytes(file);
        for (std::size_t n = 0; n < bytes.size(); ++n) {
            MemorySource source(std::span<const std::uint8_t>(bytes).first(n));
            const auto texture = n < 12 ? Result<Texture>(Error{"short", "", ""}) : ktx2_texture(source);
            REQUIRE(!texture);
            CHECK(!texture.error().what.empty());
        }
        for (std::size_t at = 12; at < std::min<std::size_t>(bytes.size(), 500); ++at)
            for (std::uint8_t change : {0x01, 0x80, 0xff}) {
                auto changed = bytes;
                changed[at] ^= change;
                MemorySource source(changed);
                const auto texture = ktx2_texture(source);
                if (!texture) CHECK(!texture.error().what.empty());
                MemorySource again(changed);
                (void)!ktx2_info(again);
            }
    }
}

TEST_CASE("ktx2: headers that promise too much are refused before memory is taken") {
    const TemporaryFolder folder;
    const auto file = folder / "a.ktx2";
    REQUIRE(write_ktx2(file, sample_texture(Encoding::rgba32f, 4, 6, 1), Supercompression::zstd));
    const auto bytes = file_bytes(file);
    const auto refused = [&](std::size_t at, std::uint32_t a, std::uint32_t b, const char* what) {
        auto changed = bytes;
        set_u32(changed, at, a);
        set_u32(changed, at + 4, b);
        MemorySource source(changed);
        const auto texture = ktx2_texture(source);
        REQUIRE(!texture);
        CHECK_MESSAGE(texture.error().what.find(what) != std::string::npos, texture.error().what);
    };
    refused(20, 0, 0, "width of 0");
    refused(20, 100000, 100000, "more than the limit");
    refused(20, 0xffffffff, 0xffffffff, "more than any texture has");
    refused(20, 4, 5, "a cube of 4 x 5");
    refused(36, 7, 1, "faces of 7");
    refused(36, 6, 9, "9 levels");
    refused(80 + 8, 0xffffffff, 0x7fffffff, "ends too early");
    // A size that fits its own header, but not what the few packed bytes can hold.
    auto changed = bytes;
    set_u32(changed, 20, 2048);
    set_u32(changed, 24, 2048);
    const std::uint64_t needed = 6ull * 2048 * 2048 * 16;
    set_u32(changed, 80 + 16, std::uint32_t(needed));
    MemorySource source(changed);
    const auto texture = ktx2_texture(source);
    REQUIRE(!texture);
    CHECK(texture.error().what == "level 0 holds another number of bytes than its size needs");
    // The same in a frame that does not state its size: one block, a byte repeated 1024 times.
    const std::vector<std::uint8_t> frame{0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x00, 0x03, 0x20, 0x00, 0x55};
    changed.resize(u64(changed, 80));
    changed.insert(changed.end(), frame.begin(), frame.end());
    set_u32(changed, 80 + 8, std::uint32_t(frame.size()));
    MemorySource again(changed);
    const auto unstated = ktx2_texture(again);
    REQUIRE(!unstated);
    CHECK(unstated.error().what == "level 0 is packed into fewer bytes than its size can need");
}

TEST_CASE("ktx2: the conformance suite's invalid files give a result or one error") {
    const auto data = data_folder();
    if (!data || !std::filesystem::exists(*data / "malformed/ktx2_cts"))
        return note_skip("DOMELIGHT_DATA has no malformed/ktx2_cts");
    int files = 0, refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*data / "malformed/ktx2_cts")) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const auto info = read_texture_info(entry.path());
        const auto texture = read_texture(entry.path());
        if (!info) {
            ++refused;
            CHECK(info.error().where == entry.path().string());
            CHECK(!info.error().what.empty());
            CHECK(!texture);
        } else {
            CHECK(info->decodable == bool(texture));
        }
        const std::string name = entry.path().filename().string();
        for (const char* fatal : {"UnexpectedEOF", "WidthZero", "InvalidFaceCount", "CubeHeightWidthMismatch_16x12"})
            if (name.find(fatal) != std::string::npos) CHECK_MESSAGE(!info, name);
    }
    CHECK(files > 500);
    MESSAGE("ktx2_cts: " << files << " files, " << refused << " refused");
}

namespace {

/// The same one-level file with its texels compressed by zlib.
std::vector<std::uint8_t> with_zlib(std::vector<std::uint8_t> bytes) {
    const std::size_t at = u64(bytes, 80), size = u64(bytes, 88);
    uLongf packed_size = compressBound(size);
    std::vector<std::uint8_t> packed(packed_size);
    REQUIRE(compress(packed.data(), &packed_size, bytes.data() + at, size) == Z_OK);
    packed.resize(packed_size);
    bytes.resize(at);
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    set_u32(bytes, 44, 3);
    set_u32(bytes, 88, std::uint32_t(packed.size()));
    return bytes;
}

double srgb_to_linear(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("ktx2: zlib supercompression is undone, and refused where it holds another size") {
    const TemporaryFolder folder;
    const Texture texture = sample_texture(Encoding::rgba16f, 10, 6, 1);
    REQUIRE(write_ktx2(folder / "a.ktx2", texture));
    const auto packed = with_zlib(file_bytes(folder / "a.ktx2"));
    MemorySource source(packed);
    const auto back = ktx2_texture(source);
    REQUIRE_MESSAGE(back, back.error().format());
    CHECK(same_texels(*back, texture));
    CHECK(ktx2_info(source)->decodable);
    auto damaged = packed;
    damaged[u64(packed, 80) + 20] ^= 0x55;
    MemorySource broken(damaged);
    CHECK_FALSE(ktx2_texture(broken));
    auto larger = packed;
    set_u32(larger, 20, 11);  // the width
    set_u32(larger, 24, 11);
    set_u32(larger, 96, 11 * 11 * 6 * 8);
    MemorySource wrong(larger);
    const auto refused = ktx2_texture(wrong);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().what.find("another number of bytes") != std::string::npos);
}

TEST_CASE("ktx: eight bits a channel are decoded by the curve that the format states, or as one says") {
    const TemporaryFolder folder;
    const Texture texture = sample_texture(Encoding::rgbm, 6, 6, 2);
    REQUIRE(write_ktx2(folder / "a.ktx2", texture));
    REQUIRE(write_ktx1(folder / "a.ktx", texture));
    const double red = texture.levels[1][4 * 2] / 255.0;  // texel (2, 0) of level 1
    struct Case {
        const char* file;
        std::size_t format_at;
        std::uint32_t srgb, unorm;
    };
    for (const Case& c : {Case{"a.ktx2", 12, 43, 37}, Case{"a.ktx", 28, 0x8c43, 0x8058}}) {
        CAPTURE(c.file);
        auto bytes = file_bytes(folder / c.file);
        // Without the key the texels are those of a picture.
        const std::string key = "domelight.encoding";
        *std::search(bytes.begin(), bytes.end(), key.begin(), key.end()) = 'x';
        for (const bool srgb : {true, false}) {
            set_u32(bytes, c.format_at, srgb ? c.srgb : c.unorm);
            write_bytes(folder / "b", bytes);
            CHECK(read_texture_info(folder / "b")->eight_bits);
            CHECK(read_texture_info(folder / "b")->decodable);
            const auto screen = read_texture(folder / "b");
            REQUIRE_MESSAGE(screen, screen.error().format());
            CHECK(decode_texture(*screen, 1, 0).at(2, 0)[0] ==
                  doctest::Approx(srgb ? srgb_to_linear(red) : red).epsilon(1e-3));
            const auto kept = read_texture(folder / "b", Decode::rgbm);
            REQUIRE(kept);
            CHECK(same_texels(*kept, texture));
        }
    }
}

TEST_CASE("ktx: the cubes of other tools that are packed with zlib or hold eight bits a channel") {
    DOMELIGHT_DATA_FILE(zlib, "reports/k2_zlib.ktx2");
    DOMELIGHT_DATA_FILE(screen, "reports/k2_rgba8srgb.ktx2");
    const auto light = read_texture(zlib);
    REQUIRE_MESSAGE(light, light.error().format());
    // Red is 1.5 + x, blue 1.5 + z, of the direction at each texel; here at the face +X.
    const ImageF face = decode_texture(*light, 0, 0);
    CHECK(face.at(8, 8)[0] == doctest::Approx(2.5).epsilon(0.01));
    CHECK(face.at(8, 8)[2] == doctest::Approx(1.5).epsilon(0.05));
    const auto picture = read_texture(screen);
    REQUIRE_MESSAGE(picture, picture.error().format());
    const auto bytes = file_bytes(screen);
    const std::size_t first = u64(bytes, 80);
    for (std::size_t c = 0; c < 3; ++c)
        CHECK(decode_texture(*picture, 0, 0).at(0, 0)[c] ==
              doctest::Approx(srgb_to_linear(bytes[first + c] / 255.0)).epsilon(1e-3));
}

TEST_CASE("ktx2: a foreign cube of BC7 blocks, packed with zstd") {
    DOMELIGHT_DATA_FILE(file, "env_projections/Ryfjallet_cubemap_bc7.ktx2");
    const auto info = read_texture_info(file);
    REQUIRE(info);
    CHECK(info->format == "VK_FORMAT_BC7_SRGB_BLOCK");
    CHECK(info->supercompression == "zstd");
    CHECK(info->faces == 6);
    CHECK(info->width == 512);
    CHECK(info->decodable);
    const auto texture = read_texture(file);
    REQUIRE_MESSAGE(texture, texture.error().format());
    // The sky is bright and blue, the ground is neither.
    const auto middle = [&](int face) { return decode_texture(*texture, 0, face).at(256, 256); };
    CHECK(middle(2)[2] > middle(2)[0]);
    CHECK(middle(2)[2] > 2 * middle(3)[2]);
}

TEST_CASE("vulkan_format_name: the numbers of the specification") {
    CHECK(vulkan_format_name(37) == "VK_FORMAT_R8G8B8A8_UNORM");
    CHECK(vulkan_format_name(43) == "VK_FORMAT_R8G8B8A8_SRGB");
    CHECK(vulkan_format_name(64) == "VK_FORMAT_A2B10G10R10_UNORM_PACK32");
    CHECK(vulkan_format_name(97) == "VK_FORMAT_R16G16B16A16_SFLOAT");
    CHECK(vulkan_format_name(109) == "VK_FORMAT_R32G32B32A32_SFLOAT");
    CHECK(vulkan_format_name(122) == "VK_FORMAT_B10G11R11_UFLOAT_PACK32");
    CHECK(vulkan_format_name(123) == "VK_FORMAT_E5B9G9R9_UFLOAT_PACK32");
    CHECK(vulkan_format_name(126) == "VK_FORMAT_D32_SFLOAT");
    CHECK(vulkan_format_name(127) == "VK_FORMAT_S8_UINT");
    CHECK(vulkan_format_name(143) == "VK_FORMAT_BC6H_UFLOAT_BLOCK");
    CHECK(vulkan_format_name(157) == "VK_FORMAT_ASTC_4x4_UNORM_BLOCK");
    CHECK(vulkan_format_name(184) == "VK_FORMAT_ASTC_12x12_SRGB_BLOCK");
    CHECK(vulkan_format_name(1000066004) == "VK_FORMAT_ASTC_6x6_SFLOAT_BLOCK");
    CHECK(vulkan_format_name(0xfeedfeed) == "VkFormat 4277010157");
}
