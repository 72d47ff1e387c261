#pragma once

#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

#include "c/border.h"

#include <memory>

/// Pixels that were made for the caller: the faces of a cube one below the other, or one picture.
struct domelight_image {
    std::shared_ptr<const domelight::ImageF> image;
    int faces = 1;
};

namespace domelight::c {

/// How the caller sees an image whose faces lie one below the other.
domelight_pixels pixels_of(const ImageF& image, int faces);

/// The caller's pixels, copied: `channels` floats each (a fourth channel is left out), the faces one below the other.
/// `name`: of the argument, for errors. Errors: no pixels, or a shape or kind of them that does not exist.
Result<ImageF> copy_pixels(const domelight_pixels& pixels, int channels);

/// An error unless all radiance is finite and not negative. The texel is named, and the face of a cube.
Result<void> check_faces(const ImageF& image, int faces);

}  // namespace domelight::c
