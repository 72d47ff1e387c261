// Reader of a scene's textures (PNG, JPEG, WebP) on arbitrary bytes.
#include "io/picture/texture_image.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto claimed = domelight::texture_image_size({data, size});
    if (!claimed || std::int64_t(claimed->width) * claimed->height > 4 << 20) return 0;
    const auto image = domelight::decode_texture_image({data, size});
    if (image && image->rgba.size() != std::size_t(image->width) * std::size_t(image->height) * 4) std::abort();
    return 0;
}
