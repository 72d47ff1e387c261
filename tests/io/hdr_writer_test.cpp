#include "domelight/io/write_image.h"

#include "io/io_helpers.h"
#include "test.h"
#include "texture/texel/rgbe.h"

#include <cmath>
#include <cstdio>
#include <string>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A plain decoder for the writer's files: a header, then rows that are flat or in the new run-length encoding.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
};

Picture decode(const std::vector<std::uint8_t>& bytes) {
    const std::string text(bytes.begin(), bytes.end());
    REQUIRE(text.starts_with("#?RADIANCE\n"));
    std::size_t at = text.find("\n\n") + 2;
    CHECK(text.substr(0, at).find("\nFORMAT=32-bit_rle_rgbe\n") != std::string::npos);
    Picture p;
    REQUIRE(std::sscanf(text.c_str() + at, "-Y %d +X %d\n", &p.height, &p.width) == 2);
    at = text.find('\n', at) + 1;
    p.texels.resize(std::size_t(p.width) * std::size_t(p.height));
    for (std::size_t row = 0; row < std::size_t(p.height); ++row) {
        auto* out = p.texels.data() + row * std::size_t(p.width);
        if (p.width < 8 || p.width > 32767) {
            for (int x = 0; x < p.width; ++x)
                for (std::size_t c = 0; c < 4; ++c) out[x][c] = bytes.at(at++);
            continue;
        }
        REQUIRE(bytes.at(at) == 2);
        REQUIRE(bytes.at(at + 1) == 2);
        REQUIRE((bytes.at(at + 2) << 8 | bytes.at(at + 3)) == p.width);
        at += 4;
        for (std::size_t c = 0; c < 4; ++c)
            for (int x = 0; x < p.width;) {
                int count = bytes.at(at++);
                const bool run = count > 128;
                if (run) count -= 128;
                REQUIRE(count > 0);
                REQUIRE(x + count <= p.width);
                for (int i = 0; i < count; ++i) out[x++][c] = bytes.at(run ? at : at++);
                if (run) ++at;
            }
    }
    REQUIRE(at == bytes.size());
    return p;
}

ImageF sample_image(int width, int height) {
    ImageF image(width, height, 3);
    std::uint32_t state = 5;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // Rows of noise, of one colour, and of long and short runs.
            const bool fresh = x == 0 || y % 3 == 0 || (y % 3 == 2 && (state >> 20) % 7 == 0);
            for (int c = 0; c < 3; ++c) {
                state = state * 1664525u + 1013904223u;
                image.at(x, y)[c] = fresh ? std::exp2(float(state >> 8) * 0x1p-24f * 20 - 10) : image.at(x - 1, y)[c];
            }
        }
    return image;
}

/// Passes rows on and fails at one of them.
class FailingRows : public RowSource {
  public:
    int width() const override { return 16; }
    int height() const override { return 300; }
    Result<void> read(ImageView<float> rows) override {
        done_ += rows.height;
        if (done_ > 100) return Error{"the source broke", "", ""};
        return {};
    }

  private:
    int done_ = 0;
};

}  // namespace

TEST_CASE("write_hdr: an independent decoder finds the nearest RGBE of every texel, at all widths") {
    const TemporaryFolder folder;
    const auto file = folder / "a.hdr";
    for (auto [width, height] :
         {std::pair{1, 1}, {7, 3}, {8, 4}, {127, 5}, {128, 6}, {129, 6}, {300, 200}, {32767, 2}, {32768, 2}}) {
        const ImageF image = sample_image(width, height);
        REQUIRE(write_hdr(file, image, 2));
        const Picture p = decode(file_bytes(file));
        REQUIRE(p.width == width);
        REQUIRE(p.height == height);
        for (std::size_t i = 0; i < p.texels.size(); ++i) {
            const float* v = image.pixels().data() + 3 * i;
            REQUIRE(p.texels[i] == rgbe_from_rgb(v[0], v[1], v[2]));
        }
    }
}

TEST_CASE("write_hdr: runs make a constant image small, noise grows by less than 2 %") {
    const TemporaryFolder folder;
    const auto file = folder / "a.hdr";
    REQUIRE(write_hdr(file, ImageF(1024, 16, 3, 0.25f)));
    CHECK(std::filesystem::file_size(file) < 16 * (4 + 4 * 2 * 9) + 120);
    ImageF noise(1024, 16, 3);
    std::uint32_t state = 5;
    for (float& p : noise.pixels()) p = float((state = state * 1664525u + 1013904223u) >> 8);
    REQUIRE(write_hdr(file, noise));
    CHECK(std::filesystem::file_size(file) < 1024 * 16 * 4 * 1.02);
}

TEST_CASE("write_hdr: the same bytes on any number of threads, from a view and from rows") {
    const TemporaryFolder folder;
    const ImageF image = sample_image(77, 150);
    REQUIRE(write_hdr(folder / "1.hdr", image, 1));
    const auto expected = file_bytes(folder / "1.hdr");
    for (int threads : {2, 3, 8}) {
        REQUIRE(write_hdr(folder / "n.hdr", image, threads));
        CHECK(file_bytes(folder / "n.hdr") == expected);
    }
    ImageRowSource rows(image.view());
    REQUIRE(write_hdr(folder / "r.hdr", rows));
    CHECK(file_bytes(folder / "r.hdr") == expected);
}

TEST_CASE("write_hdr: a source that fails leaves nothing behind") {
    const TemporaryFolder folder;
    FailingRows rows;
    const auto written = write_hdr(folder / "a.hdr", rows);
    REQUIRE(!written);
    CHECK(written.error().what == "the source broke");
    CHECK(std::filesystem::is_empty(folder.path()));
}
