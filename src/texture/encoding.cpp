// Sizes and ranges of the encodings.
#include "domelight/texture/texture.h"

#include "texture/block/uastc_hdr.h"
#include "texture/texel/half.h"
#include "texture/texel/r11g11b10f.h"
#include "texture/texel/rgb9e5.h"
#include "texture/texel/rgba8_ranges.h"

#include <iterator>
#include <limits>

namespace domelight {

namespace {

struct EncodingFacts {
    Encoding encoding;
    int block, bytes, channels;
    double max;
};

/// In the order of the enumeration.
constexpr EncodingFacts k_facts[] = {
    {Encoding::rgba16f, 1, 8, 3, k_half_max},
    {Encoding::rgba32f, 1, 16, 3, std::numeric_limits<float>::max()},
    {Encoding::rgb9e5, 1, 4, 3, k_rgb9e5_max},
    {Encoding::r11g11b10f, 1, 4, 3, k_float10_max},
    {Encoding::rg16f, 1, 4, 2, k_half_max},
    {Encoding::rg32f, 1, 8, 2, std::numeric_limits<float>::max()},
    {Encoding::r32f, 1, 4, 1, std::numeric_limits<float>::max()},
    {Encoding::bc6h, 4, 16, 3, k_half_max},
    {Encoding::rgbm, 1, 4, 3, k_rgbm_max},
    {Encoding::rgbd, 1, 4, 3, k_rgbd_max},
    {Encoding::rgbp, 1, 4, 3, k_rgbp_max},
    {Encoding::uastc_hdr, 4, 16, 3, k_uastc_hdr_max},
    {Encoding::astc4x4_hdr, 4, 16, 3, k_half_max},
    {Encoding::astc6x6_hdr, 6, 16, 3, k_half_max},
};

constexpr bool in_order() {
    for (std::size_t i = 0; i < std::size(k_facts); ++i)
        if (k_facts[i].encoding != Encoding(i)) return false;
    return true;
}
static_assert(in_order());

const EncodingFacts& facts(Encoding encoding) {
    return k_facts[std::size_t(encoding)];
}

}  // namespace

int encoding_block(Encoding encoding) {
    return facts(encoding).block;
}

int encoding_channels(Encoding encoding) {
    return facts(encoding).channels;
}

int encoding_bytes(Encoding encoding) {
    return facts(encoding).bytes;
}

double encoding_max(Encoding encoding) {
    return facts(encoding).max;
}

}  // namespace domelight
