#pragma once

#include "domelight/image/row_source.h"

#include "projection/latlong_convention.h"

#include <memory>

namespace domelight {

/// A lat-long image sampled on another grid, resampled row by row to texel centres of the same size: each texel is the
/// bilinear reconstruction of the source's own samples at that texel's centre. Holds two source rows.
std::unique_ptr<RowSource> regrid_latlong(std::unique_ptr<RowSource> source, LatlongConvention::Grid grid);

}  // namespace domelight
