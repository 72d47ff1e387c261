#pragma once

#include "filtering/lights/point_lights.h"

#include <span>
#include <vector>

namespace domelight {

/// Point lights in groups of 16 neighbours, so that a sum over lights can skip all of a group by one test.
struct LightGroups {
    /// Lights in a group.
    static constexpr int k_size = 16;
    /// The number of groups is rounded up to a multiple of this; those that are added are `k_size` lights of no power.
    static constexpr int k_padding = 16;

    LightGroups() = default;
    explicit LightGroups(const PointLights& points);

    int count() const { return int(x.size()); }
    bool empty() const { return x.empty(); }

    PointLights lights;          ///< k_size of each group; the last ones of a group may have no power
    int used = 0;                ///< lights that have power
    std::vector<float> x, y, z;  ///< unit direction of a group's centre
    std::vector<float> radius;   ///< the greatest chord from the centre to one of the lights
    std::vector<Vec3d> most;     ///< of each channel, the power of the group's strongest light
};

}  // namespace domelight
