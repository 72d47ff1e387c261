#pragma once

#include "image/draw.h"

namespace domelight {

/// The colours of plots and of the other pictures on white paper.
inline constexpr Colour8 k_paper{255, 255, 255}, k_ink{30, 34, 40}, k_faint_ink{110, 116, 124};

}  // namespace domelight
