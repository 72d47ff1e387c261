#include "domelight/texture.h"

#include "test.h"

#include <fstream>
#include <iterator>

using namespace domelight;

namespace {
std::vector<std::uint8_t> file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

TEST_CASE("write_ktx2: starts with the identifier and ends with level 0") {
    std::vector<FilteredMap> levels(2);
    levels[0].cube = Cubemap(4);
    levels[1].cube = Cubemap(2);
    for (auto& level : levels)
        for (float& p : level.pixels()) p = 0.5f;
    const Texture texture = encode_texture(levels, Encoding::rgba16f, 1);
    const test::TemporaryFolder folder;
    const auto file = folder / "a.ktx2";
    const auto written = write_ktx2(file, texture);
    REQUIRE(written);
    const auto bytes = file_bytes(file);
    CHECK(bytes.size() > 80 + 2 * 24 + 6 * 8 * (16 + 4));
    CHECK(bytes[1] == 'K');
    CHECK(std::equal(texture.levels[0].rbegin(), texture.levels[0].rend(), bytes.rbegin()));
}
