#include "texture/container/texture_stream.h"

#include "domelight/texture/texture.h"

#include "io/file/sha256.h"
#include "test.h"
#include "texture/chain_encoder.h"

#include <cmath>
#include <fstream>
#include <iterator>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A chain of noise, with texels beyond the range of every encoding.
std::vector<FilteredMap> noise_chain(bool cube, int size, int levels) {
    std::vector<FilteredMap> chain(static_cast<std::size_t>(levels));
    std::uint32_t state = 11;
    for (int l = 0; l < levels; ++l) {
        FilteredMap& map = chain[std::size_t(l)];
        if (cube)
            map = Cubemap(size >> l);
        else
            map = {Layout::latlong, ImageF(2 * (size >> l), size >> l, 3)};
        for (float& p : map.pixels()) {
            state = state * 1664525u + 1013904223u;
            p = std::exp2(float(state >> 8) * 0x1p-24f * 24 - 6);
        }
    }
    return chain;
}

std::vector<std::uint8_t> file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

using LayoutOf = Result<TextureLayout> (*)(const Texture&, std::span<const std::uint64_t>);
using Write = Result<void> (*)(const std::filesystem::path&, const Texture&);

Result<TextureLayout> plain_ktx2_layout(const Texture& texture, std::span<const std::uint64_t> bytes) {
    return ktx2_layout(texture, bytes, Supercompression::none, bytes);
}
Result<void> plain_write_ktx2(const std::filesystem::path& file, const Texture& texture) {
    return write_ktx2(file, texture);
}

bool same(const EncodingReport& a, const EncodingReport& b) {
    return a.clipped_texels == b.clipped_texels && a.clipped_energy == b.clipped_energy && a.rms_error == b.rms_error;
}

}  // namespace

TEST_CASE(
    "encode_to_file: the same file, reports and hash as encoding first and writing then, on any number of threads") {
    const TemporaryFolder folder;
    const std::map<std::string, std::string> metadata{{"domelight.quantity", "radiance"}};
    const std::pair<LayoutOf, Write> containers[] = {
        {plain_ktx2_layout, plain_write_ktx2}, {ktx1_layout, write_ktx1}, {dds_layout, write_dds}};
    for (const bool cube : {true, false}) {
        const auto chain = noise_chain(cube, 96, 4);
        for (const Encoding encoding : {Encoding::rgba16f, Encoding::rgb9e5, Encoding::rgba32f, Encoding::bc6h}) {
            std::vector<EncodingReport> reports;
            Texture texture = encode_texture(chain, encoding, 1, &reports);
            texture.metadata = metadata;
            for (const auto& [layout_of, write] : containers) {
                REQUIRE(write(folder / "whole", texture));
                const auto expected = file_bytes(folder / "whole");
                for (const int threads : {1, 2, 5}) {
                    ChainEncoder encoder(chain, encoding, metadata);
                    const auto layout = layout_of(encoder.head(), encoder.level_bytes());
                    REQUIRE(layout);
                    CHECK(layout->size == expected.size());
                    const auto hash = encode_to_file(folder / "stream", encoder, *layout, threads, threads != 2);
                    REQUIRE(hash);
                    CHECK(file_bytes(folder / "stream") == expected);
                    CHECK(*hash == (threads != 2 ? sha256(expected) : ""));
                    const auto again = encoder.reports();
                    REQUIRE(again.size() == reports.size());
                    for (std::size_t l = 0; l < reports.size(); ++l) CHECK(same(again[l], reports[l]));
                }
            }
        }
    }
}

TEST_CASE("encode_to_file: a place that takes no file is an error, and nothing stays") {
    const TemporaryFolder folder;
    const auto chain = noise_chain(true, 32, 2);
    ChainEncoder encoder(chain, Encoding::rgba16f);
    const auto layout = plain_ktx2_layout(encoder.head(), encoder.level_bytes());
    REQUIRE(layout);
    const auto written = encode_to_file(folder / "nowhere" / "a.ktx2", encoder, *layout, 2, true);
    REQUIRE(!written);
    CHECK(written.error().where.find("a.ktx2") != std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("chain encoder: rows in any pieces give the same bytes and sums") {
    const auto chain = noise_chain(true, 40, 2);
    std::vector<EncodingReport> reports;
    const Texture texture = encode_texture(chain, Encoding::r11g11b10f, 1, &reports);
    ChainEncoder encoder(chain, Encoding::r11g11b10f);
    for (int l = 1; l >= 0; --l) {
        const int rows = 6 * encoder.rows(l);
        std::vector<std::uint8_t> out(encoder.row_bytes(l) * std::size_t(rows));
        for (int row = rows; row > 0;) {  // from the back, in pieces of growing size
            const int count = std::min(row, 1 + (rows - row) / 2);
            row -= count;
            encoder.encode(l, row, count, out.data() + encoder.row_bytes(l) * std::size_t(row));
        }
        CHECK(std::equal(out.begin(), out.end(), texture.levels[std::size_t(l)].begin(),
                         texture.levels[std::size_t(l)].end()));
        CHECK(same(encoder.reports()[std::size_t(l)], reports[std::size_t(l)]));
    }
}
