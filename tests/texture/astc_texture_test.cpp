#include "domelight/texture/texture.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/uastc_samples.h"

#include <fstream>
#include <iterator>

using namespace domelight;

namespace {

Texture sample(Encoding encoding) {
    std::vector<FilteredMap> chain(3);
    test::Noise noise;
    for (int l = 0; l < 3; ++l) {
        chain[std::size_t(l)] = Cubemap(20 >> l);
        for (float& v : chain[std::size_t(l)].pixels()) v = noise.unit();
    }
    return encode_texture(chain, encoding, 1, nullptr, EncodingQuality::fast);
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | std::uint32_t(bytes[at + 3]) << 24;
}

}  // namespace

TEST_CASE("ktx2: astc and uastc textures come back, packed and plain") {
    const test::TemporaryFolder folder;
    for (const Encoding encoding : {Encoding::uastc_hdr, Encoding::astc4x4_hdr, Encoding::astc6x6_hdr})
        for (const auto packing : {Supercompression::none, Supercompression::zstd}) {
            CAPTURE(name_of(encoding));
            const Texture texture = sample(encoding);
            REQUIRE(write_ktx2(folder / "t.ktx2", texture, packing));
            const auto info = read_texture_info(folder / "t.ktx2");
            REQUIRE(info);
            CHECK(info->decodable);
            CHECK(info->format == (encoding == Encoding::astc6x6_hdr ? "VK_FORMAT_ASTC_6x6_SFLOAT_BLOCK"
                                                                     : "VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK"));
            const auto back = read_texture(folder / "t.ktx2");
            REQUIRE(back);
            CHECK(back->encoding == encoding);
            CHECK(back->levels == texture.levels);
            CHECK(back->faces == 6);
        }
}

TEST_CASE("ktx2: the descriptor of UASTC HDR is the reference encoder's, word by word") {
    const test::TemporaryFolder folder;
    REQUIRE(write_ktx2(folder / "t.ktx2", sample(Encoding::uastc_hdr), Supercompression::zstd));
    const auto bytes = bytes_of(folder / "t.ktx2");
    CHECK(word(bytes, 12) == 1000066000);
    CHECK(word(bytes, 16) == 1);  // type size
    const std::size_t at = word(bytes, 48);
    const std::uint32_t expected[] = {44, 0, 0x00280002, 0x000101a7, 0x00000303, 16, 0, 0x807f0000, 0, 0, 0x3f800000};
    CHECK(word(bytes, 52) == sizeof expected);
    for (std::size_t i = 0; i < std::size(expected); ++i) CHECK(word(bytes, at + 4 * i) == expected[i]);
}

TEST_CASE("ktx1: astc textures come back; its one number for 4 x 4 does not tell UASTC from ASTC") {
    const test::TemporaryFolder folder;
    for (const Encoding encoding : {Encoding::uastc_hdr, Encoding::astc4x4_hdr, Encoding::astc6x6_hdr}) {
        const Texture texture = sample(encoding);
        REQUIRE(write_ktx1(folder / "t.ktx", texture));
        const auto back = read_texture(folder / "t.ktx");
        REQUIRE(back);
        CHECK(back->encoding == (encoding == Encoding::uastc_hdr ? Encoding::astc4x4_hdr : encoding));
        CHECK(back->levels == texture.levels);
        CHECK(decode_texture(*back, 1, 2).pixels().size() == 300);
    }
}

TEST_CASE("dds: has no ASTC, and says so") {
    const test::TemporaryFolder folder;
    const auto written = write_dds(folder / "t.dds", sample(Encoding::uastc_hdr));
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find("uastc-hdr") != std::string::npos);
    CHECK(written.error().hint.find("ktx2") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "t.dds"));
}

TEST_CASE("ktx2: other sizes and kinds of ASTC are named in the error") {
    const test::TemporaryFolder folder;
    REQUIRE(write_ktx2(folder / "t.ktx2", sample(Encoding::astc4x4_hdr)));
    auto bytes = bytes_of(folder / "t.ktx2");
    const auto with_format = [&](std::uint32_t format) {
        for (std::size_t i = 0; i < 4; ++i) bytes[12 + i] = std::uint8_t(format >> 8 * i);
        std::ofstream(folder / "u.ktx2", std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        const auto texture = read_texture(folder / "u.ktx2");
        REQUIRE_FALSE(texture);
        return texture.error();
    };
    CHECK(with_format(1000066007).what.find("VK_FORMAT_ASTC_8x8_SFLOAT_BLOCK") != std::string::npos);
    const Error ldr = with_format(157);
    CHECK(ldr.what.find("VK_FORMAT_ASTC_4x4_UNORM_BLOCK") != std::string::npos);
    CHECK(ldr.hint.find("ASTC HDR 4x4 and 6x6") != std::string::npos);
    // A size that does not fit the blocks.
    CHECK(with_format(1000066004).what.find("level 0 has") != std::string::npos);
}
