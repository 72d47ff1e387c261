#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <filesystem>
#include <functional>

namespace domelight {

struct AnimationOptions {
    double frames_per_second = 30;  ///< 1 .. 1000
    float quality = 92;             ///< 0 .. 100, of the lossy coding
    bool lossless = false;
};

/// An animated WebP that repeats for ever. `frame(i)` gives the pixels of frame i (sRGB, 3 or 4 channels, all of one
/// size); only one frame is in memory at a time. Errors: no frames; a frame of another size than the first, or larger
/// than WebP's 16383; an error from `frame`; a failure to write.
Result<void> write_webp_animation(const std::filesystem::path& file, int frames,
                                  const std::function<Result<Image<std::uint8_t>>(int)>& frame,
                                  const AnimationOptions& options = {});

}  // namespace domelight
