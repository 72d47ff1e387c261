#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"
#include "domelight/image/repair_report.h"

#include <array>
#include <optional>
#include <span>

namespace domelight {

/// The largest radiance that readers return. No light is nearly as bright, and sums over the brightest possible image
/// stay finite in float.
inline constexpr float k_largest_radiance = 0x1p100f;

/// How to turn stored texels into radiance: finite, in [0, k_largest_radiance], linear Rec. 709.
struct RepairOptions {
    float largest = k_largest_radiance;  ///< the format's largest finite value, which replaces infinity before `scale`
                                         ///< is applied
    std::optional<Mat3> to_rec709 = std::nullopt;  ///< the file's primaries to Rec. 709
    float scale = 1;                               ///< exposure
    bool wraps = true;                             ///< the row's ends are neighbours (lat-long)
};

/// Repairs one row of RGB texels in place and counts the repairs in `report`. In this order: a texel with a NaN becomes
/// the mean of the nearest texels without one to its left and right (0 if the row has none); infinities become
/// `largest` (-infinity becomes 0); the primaries are converted and the scale is applied; negative channels become 0;
/// and values above k_largest_radiance are clipped to it and counted with the infinities.
void repair_row(std::span<float> rgb, const RepairOptions& options, RepairReport& report);

/// Adds the counts of `part` to `sum`; the warnings of `sum` do not change.
void add_repairs(RepairReport& sum, const RepairReport& part);

}  // namespace domelight
