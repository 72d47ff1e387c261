#pragma once

#include "image/draw.h"

namespace domelight {

/// The colours and spaces (in pixels) of the dark pages on which previews are laid out.
inline constexpr Colour8 k_background{24, 25, 28}, k_bright{232, 234, 238}, k_text{205, 208, 214},
    k_quiet{139, 144, 153};
inline constexpr int k_margin = 32, k_gap = 16;

}  // namespace domelight
