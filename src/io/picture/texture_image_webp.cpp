#include "io/picture/texture_image.h"

#include <webp/decode.h>

namespace domelight {

Result<TextureSize> webp_size(std::span<const std::uint8_t> bytes) {
    TextureSize size;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &size.width, &size.height))
        return Error{"not a readable WebP", "", "The file is truncated or damaged."};
    return size;
}

Result<Rgba8Image> decode_webp_texture(std::span<const std::uint8_t> bytes) {
    const auto size = texture_image_size(bytes);
    if (!size) return size.error();
    Rgba8Image image;
    image.width = size->width, image.height = size->height;
    image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(), image.width * 4))
        return Error{"not a readable WebP", "", "The file is truncated or damaged."};
    return image;
}

}  // namespace domelight
