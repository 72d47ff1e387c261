// Functions of the library whose libraries the module leaves out. npm/index.js refuses what would call them, and says so.

#include "texture/block/astc_codec.h"
#include "texture/block/uastc_hdr.h"

#include <cstdlib>

namespace domelight {

void encode_astc_hdr(int, const float*, int, EncodingQuality, std::uint8_t*) {
    std::abort();
}
void decode_astc_hdr(int, const std::uint8_t*, int, float*) {
    std::abort();
}
void encode_uastc_hdr(const float*, int, EncodingQuality, std::uint8_t*) {
    std::abort();
}
void decode_uastc_hdr(const std::uint8_t*, int, float*) {
    std::abort();
}

}  // namespace domelight
