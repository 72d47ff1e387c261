#pragma once

#include "io/image_reader.h"

namespace domelight {

/// The texel of an image as stored that is seen at column x of row y, by Exif's orientation (1 to 8).
const float* seen_texel(const ImageF& stored, int orientation, int x, int y);

/// The image of `reader` as Exif's orientation (1 to 8) says that it is to be seen, with a note. All of it is in memory
/// for that, unless it is stored as seen.
/// Errors: it would need more than `max_bytes`.
Result<std::unique_ptr<ImageReader>> oriented_reader(std::unique_ptr<ImageReader> reader, int orientation,
                                                     std::int64_t max_bytes);

}  // namespace domelight
