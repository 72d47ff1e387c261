#include "codec/bc6h_encode.h"

#include "codec/bc6h.h"
#include "codec/half.h"

#include <algorithm>
#include <cmath>

namespace domelight::bc6h {

namespace {

/// Mode 11 from the corners of the box around the texels.
void encode_block(const float* rgb, std::uint8_t* block) {
    int low[3], high[3], value[k_texels][3];
    for (int c = 0; c < 3; ++c) {
        low[c] = 0xffff, high[c] = 0;
        for (int t = 0; t < k_texels; ++t) {
            value[t][c] = (half_from_float(rgb[3 * t + c]) * 64 + 31) / 31;
            low[c] = std::min(low[c], value[t][c]);
            high[c] = std::max(high[c], value[t][c]);
        }
    }
    Fields fields;
    fields.mode = 10;
    double length = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        fields.endpoint[0][c] = low[c] * 1023 / 0xffff;
        fields.endpoint[1][c] = high[c] * 1023 / 0xffff;
        length += double(high[c] - low[c]) * double(high[c] - low[c]);
    }
    for (std::size_t t = 0; t < k_texels; ++t) {
        double along = 0;
        for (int c = 0; c < 3; ++c) along += double(value[t][c] - low[c]) * double(high[c] - low[c]);
        fields.index[t] = std::uint8_t(length > 0 ? std::lround(15 * along / length) : 0);
    }
    if (fields.index[0] > 7) {
        std::swap(fields.endpoint[0], fields.endpoint[1]);
        for (auto& index : fields.index) index = std::uint8_t(15 - index);
    }
    pack(fields, block);
}

}  // namespace

void encode(const float* texels, int count, EncodingQuality, std::uint8_t* blocks) {
    for (int i = 0; i < count; ++i) encode_block(texels + 48 * i, blocks + k_block_bytes * i);
}

}  // namespace domelight::bc6h
