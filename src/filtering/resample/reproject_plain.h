#pragma once

#include "domelight/filtering/resample/reproject.h"

namespace domelight::reproject_detail {

/// reproject() in its plain form: every position and every integral in scalar doubles.
ProjectedImage reproject_plain(const ProjectedImage& source, const Projection& target, int width, int height,
                               int threads = 0);

}  // namespace domelight::reproject_detail
