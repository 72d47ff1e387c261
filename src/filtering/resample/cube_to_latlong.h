#pragma once

#include "filtering/resample/area_resample_aligned.h"

namespace domelight::area {

/// area_resample_cube_to_latlong where the lat-long image's polar axis is an axis of the cube, about forty times as
/// fast as plain_cube_to_latlong: along a meridian the integral over the texel is a sum over the cells that it crosses,
/// and the weights of the cells are computed once for all the turns and the two hemispheres where they repeat.
/// `source_to_world` is world_to_source transposed, as align() divides it.
ImageF aligned_cube_to_latlong(const Cubemap& source, int out_height, const AlignedOrientation& source_to_world,
                               int threads);

}  // namespace domelight::area
