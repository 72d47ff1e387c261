#include "domelight/texture.h"

#include "io/io_helpers.h"
#include "io/texture_reading.h"
#include "test.h"

#include <algorithm>
#include <cstring>

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
