#pragma once

#include "domelight/base/result.h"
#include "domelight/image/rgba8_image.h"

#include <cstdint>
#include <memory>
#include <span>

namespace domelight {

class FileBytes;

/// The width and height of a PNG, JPEG or WebP image, from its header, if the number of bytes is enough for that size.
/// Errors: another format, a broken header.
struct TextureSize {
    int width = 0, height = 0;
};
Result<TextureSize> texture_image_size(std::span<const std::uint8_t> bytes);
/// The size that a WebP's header states.
Result<TextureSize> webp_size(std::span<const std::uint8_t> bytes);

/// Its texels as stored: 8 bits, RGBA, top row first. 16-bit samples lose their lower half; colour profiles and gamma
/// are ignored, as glTF asks. Errors: truncated or damaged.
Result<Rgba8Image> decode_texture_image(std::span<const std::uint8_t> bytes);

/// The same by format.
Result<Rgba8Image> decode_png_texture(std::span<const std::uint8_t> bytes);
Result<Rgba8Image> decode_jpeg_texture(std::span<const std::uint8_t> bytes);
Result<Rgba8Image> decode_webp_texture(std::span<const std::uint8_t> bytes);

}  // namespace domelight
