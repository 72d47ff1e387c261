#include "texture/block/uastc_hdr.h"
#include "texture/block/uastc_hdr_fit.h"

#include <algorithm>

namespace domelight {

namespace {

simd::UastcEffort effort(EncodingQuality quality) {
    switch (quality) {
        case EncodingQuality::fast:
            return {1, 1};
        case EncodingQuality::standard:
            return {2, 1};
        case EncodingQuality::high:
            return {3, 4};
        case EncodingQuality::exhaustive:
            break;
    }
    return {5, k_uastc_partitions};
}

}  // namespace

void encode_uastc_hdr(const float* rgb, int count, EncodingQuality quality, std::uint8_t* out) {
    float clipped[48 * simd::k_uastc_batch];
    AstcBlock blocks[simd::k_uastc_batch];
    for (int first = 0; first < count; first += simd::k_uastc_batch) {
        const int here = std::min(simd::k_uastc_batch, count - first);
        const float* from = rgb + std::size_t(first) * 48;
        // Written so that NaN becomes 0.
        for (int i = 0; i < 48 * here; ++i) clipped[i] = from[i] > 0 ? std::min(from[i], k_uastc_hdr_max) : 0;
        simd::fit_uastc_hdr(clipped, here, effort(quality), blocks);
        for (int b = 0; b < here; ++b)
            pack_astc(blocks[b], std::span<std::uint8_t, 16>(out + 16 * std::size_t(first + b), 16));
    }
}

}  // namespace domelight
