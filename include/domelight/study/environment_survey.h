#pragma once
// What an environment holds: its range, its mean, how much light falls on each side of a box, its brightest lights.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/environment/environment.h"

#include <array>
#include <vector>

namespace domelight {

/// A small bright source.
struct BrightLight {
    Vec3d direction;         ///< world, unit length: the centroid of its power
    double azimuth_deg = 0;  ///< from +X towards +Z
    double elevation_deg = 0;
    double share = 0;       ///< its part of the radiant power (luminance) of the whole sphere, [0, 1]
    double radius_deg = 0;  ///< of a disc with the solid angle of all texels at least half as bright as the peak
};

struct EnvironmentSurvey {
    float least = 0, largest = 0;     ///< values over all channels
    Vec3d mean_radiance;              ///< over the sphere, weighted by solid angle
    std::array<Vec3d, 6> irradiance;  ///< E on a surface that faces +X -X +Y -Y +Z -Z
    std::vector<BrightLight> lights;  ///< at most five, the one with the most power first
};

/// Surveys an environment. A lat-long source is read once, to its end. Errors: those of reading; "cancelled".
///
/// environment  read from its beginning
/// threads      0: all
/// progress     stages are those of prefilter()
Result<EnvironmentSurvey> survey_environment(const Environment& environment, int threads = 0,
                                             const Progress& progress = {});

}  // namespace domelight
