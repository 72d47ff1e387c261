#pragma once

#include "domelight/environment/environment.h"
#include "domelight/base/progress.h"
#include "domelight/base/vec.h"

#include <array>
#include <string>
#include <vector>

namespace domelight::cli {

/// A small bright source.
struct BrightLight {
    Vec3d direction;         ///< world, unit length: the middle of its power
    double azimuth_deg = 0;  ///< from +X towards +Z
    double elevation_deg = 0;
    double share = 0;       ///< of the sphere's radiant power (luminance)
    double radius_deg = 0;  ///< of a disc as large as what is at least half as bright as its peak
};

/// What `info` says of an environment.
struct EnvironmentSurvey {
    float least = 0, largest = 0;     ///< over all channels
    Vec3d mean_radiance;              ///< over the sphere, weighted by solid angle
    std::array<Vec3d, 6> irradiance;  ///< E on a surface that faces +X -X +Y -Y +Z -Z
    std::vector<BrightLight> lights;  ///< strongest first
};

/// Reads the environment to its end.
Result<EnvironmentSurvey> survey_environment(Environment& environment, int threads, const Progress& progress);

}  // namespace domelight::cli
