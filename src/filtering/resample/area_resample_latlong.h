#pragma once

#include "filtering/resample/area_resample_aligned.h"

namespace domelight::area {

/// area_resample_to_latlong where both images have the same polar axis (either way up): the overlap of a texel with a
/// source texel's tent is a product of one factor for the columns and one for the rows. Keeps a few rows.
std::unique_ptr<AreaResampler> aligned_to_latlong(int width, int height, int out_height,
                                                  const AlignedOrientation& orientation, int threads);

/// Whether `orientation` maps the world's +Y or -Y to the source's polar axis.
bool keeps_polar_axis(const AlignedOrientation& orientation);

}  // namespace domelight::area
