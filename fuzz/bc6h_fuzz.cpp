// BC6H blocks of arbitrary bytes, and the encoder on what they decode to.
#include "texture/block/bc6h.h"
#include "texture/block/bc6h_encode_simd.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace domelight;
    const std::size_t count = std::min<std::size_t>(size / 16, 8);
    std::vector<float> texels(48 * count);
    for (std::size_t i = 0; i < count; ++i) {
        bc6h::decode(data + 16 * i, texels.data() + 48 * i);
        bc6h::Fields fields;
        std::uint8_t again[16];
        if (bc6h::unpack(data + 16 * i, fields)) {
            bc6h::pack(fields, again);
            if (!std::equal(again, again + 16, data + 16 * i)) std::abort();
        }
    }
    for (const float v : texels)
        if (!(v >= 0 && v <= 65504)) std::abort();
    std::vector<std::uint8_t> blocks(16 * count);
    for (const EncodingQuality quality : {EncodingQuality::fast, EncodingQuality::standard}) {
        if (quality == EncodingQuality::standard && size % 8) continue;  // slow: now and then
        simd::bc6h_encode(texels.data(), int(count), quality, blocks.data());
        for (std::size_t i = 0; i < count; ++i) {
            bc6h::Fields fields;
            if (!bc6h::unpack(blocks.data() + 16 * i, fields)) std::abort();
        }
    }
    return 0;
}
