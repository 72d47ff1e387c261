#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <filesystem>

namespace domelight {

/// A small picture of a picture, an environment or a texture: 8-bit sRGB, at most `width` wide and high. Radiance is
/// exposed and tone mapped (AgX); a cube is unfolded. Errors: those of reading the file.
Result<Image<std::uint8_t>> thumbnail(const std::filesystem::path& file, int width, int threads);

}  // namespace domelight
