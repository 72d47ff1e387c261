#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/texture/texture.h"

#include <cstdint>
#include <vector>

namespace domelight {

using PngBytes = std::vector<std::uint8_t>;

/// An 8-bit PNG of 1, 3 or 4 channels in memory, without a colour space: its bytes are data (RGBD, RGBP) that no colour
/// management may change.
Result<PngBytes> encode_png(ImageView<const std::uint8_t> pixels, int compression_level = 6);

/// One PNG for each face of each level of a texture of four bytes a texel, level by level.
Result<std::vector<PngBytes>> encode_faces(const Texture& texture, int threads);

}  // namespace domelight
