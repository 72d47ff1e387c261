#include "texture/block/astc_codec.h"

#include "domelight/texture/texture.h"

#include "test.h"
#include "texture/uastc_samples.h"

#include <cmath>

using namespace domelight;

namespace {

std::vector<FilteredMap> noise_chain(int size, int levels) {
    std::vector<FilteredMap> chain(static_cast<std::size_t>(levels));
    test::Noise noise;
    for (int l = 0; l < levels; ++l) {
        chain[std::size_t(l)] = Cubemap(size >> l);
        for (float& v : chain[std::size_t(l)].pixels()) v = std::exp2(0.5f * noise.unit());
    }
    return chain;
}

}  // namespace

TEST_CASE("astc hdr: levels of any size come back, in both sizes of block") {
    const auto chain = noise_chain(26, 4);
    for (const Encoding encoding : {Encoding::astc4x4_hdr, Encoding::astc6x6_hdr}) {
        CAPTURE(name_of(encoding));
        std::vector<EncodingReport> reports;
        const Texture texture = encode_texture(chain, encoding, 2, &reports, EncodingQuality::fast);
        const auto blocks = [&](int size) { return (size + encoding_block(encoding) - 1) / encoding_block(encoding); };
        for (int l = 0; l < 4; ++l) {
            const int size = 26 >> l;
            CHECK(int(texture.levels[std::size_t(l)].size()) == 6 * blocks(size) * blocks(size) * 16);
            const ImageF face = decode_texture(texture, l, 4);
            double off = 0;
            for (std::size_t i = 0; i < face.pixels().size(); ++i)
                off = std::max(off,
                               std::abs(double(std::log2(face.pixels()[i] / chain[std::size_t(l)].face(4).data[i]))));
            CHECK(off < 0.5);  // the range of the noise
            CHECK(reports[std::size_t(l)].rms_error > 0);
            CHECK(reports[std::size_t(l)].rms_error < 0.12);
        }
    }
}

TEST_CASE("astc hdr: the same bytes on any number of threads; more effort costs no accuracy") {
    const auto chain = noise_chain(24, 1);
    for (const Encoding encoding : {Encoding::astc4x4_hdr, Encoding::astc6x6_hdr}) {
        std::vector<EncodingReport> fast, high;
        const Texture one = encode_texture(chain, encoding, 1, &fast, EncodingQuality::fast);
        CHECK(encode_texture(chain, encoding, 4, nullptr, EncodingQuality::fast).levels == one.levels);
        encode_texture(chain, encoding, 2, &high, EncodingQuality::high);
        CHECK(high[0].rms_error <= fast[0].rms_error);
    }
}

TEST_CASE("astc hdr: what is no block is black") {
    const std::uint8_t reserved[16] = {};
    float rgb[3 * 36];
    for (const int side : {4, 6}) {
        for (float& v : rgb) v = 7;
        decode_astc_hdr(side, reserved, 1, rgb);
        for (int i = 0; i < 3 * side * side; ++i) CHECK(rgb[i] == 0);
    }
}
