#pragma once

#include "domelight/texture.h"

#include <cstdint>

namespace domelight {

/// What storing a run of texels did, as weighted sums (weights: solid angle up to a factor; luminance: Rec. 709).
struct EncodeSums {
    std::int64_t clipped = 0;  ///< texels with a channel outside the encoding's range
    double power = 0;          ///< sum w L(v)
    double lost = 0;           ///< sum w L(v - clipped v), of channels above the range
    double error = 0;          ///< sum w |stored - v|^2 over texels that were not clipped
    double norm = 0;           ///< sum w |v|^2 over the same; 0 for encodings that keep every float

    void operator+=(const EncodeSums& b) {
        clipped += b.clipped;
        power += b.power;
        lost += b.lost;
        error += b.error;
        norm += b.norm;
    }
};

/// Encodes `count` RGB float texels into `out` (count * encoding_bytes(encoding) bytes) and adds up what that did;
/// `weight` has one entry a texel. Alpha is 1; two-channel encodings take red and green. NaN is stored as 0.
EncodeSums encode_row_scalar(Encoding encoding, const float* rgb, int count, const float* weight, std::uint8_t* out);

/// The same from one to three interleaved channels (missing ones are 0), without sums.
void encode_texels(Encoding encoding, const float* texels, int channels, int count, std::uint8_t* out);

/// Float texels of `count` encoded ones: RGB, or RG for two-channel encodings.
void decode_texels(Encoding encoding, const std::uint8_t* texels, int count, float* out);

}  // namespace domelight
