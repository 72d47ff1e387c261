#pragma once

#include "domelight/compare/metrics.h"

namespace domelight {

/// Whether a pixel is compared: a mask without data takes all.
inline bool counts(const Mask& mask, int x, int y) {
    return !mask.data || mask.at(x, y)[0] > 0;
}

}  // namespace domelight
