#pragma once

#include "domelight/image/image.h"

#include <vector>

namespace domelight {

/// Taps of a filter about its middle: 2 radius + 1 of them.
using Taps = std::vector<float>;

/// A one-channel image convolved by `along` in x and `down` in y; beyond the border the nearest pixel is repeated. The
/// taps are not reversed: the kernels used here are even, or odd and used only by the magnitude of their result.
ImageF filter_plane(ImageView<const float> plane, const Taps& along, const Taps& down, int threads);

}  // namespace domelight
