#pragma once

#include "domelight/filtering/resample/area_resample.h"

#include <memory>
#include <optional>

namespace domelight::area {

/// world_to_source = rotation_y(angle) * axes, where `axes` permutes and mirrors the axes and takes one of the world's
/// to the source's polar axis.
struct AlignedOrientation {
    Mat3 axes;
    double angle = 0;  ///< -45 to 45 degrees
};

/// Empty if the source's polar axis is not an axis of the world.
std::optional<AlignedOrientation> align(const Mat3& world_to_source);

/// area_resample_to_cube where the source's polar axis is an axis of the cube. Each stencil is computed once and
/// applied wherever symmetry repeats it. Keeps some rows of the source and the stencils in memory.
std::unique_ptr<AreaResampler> aligned_to_cube(int width, int height, int size, const AlignedOrientation& orientation,
                                               int threads);

}  // namespace domelight::area
