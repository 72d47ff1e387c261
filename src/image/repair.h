#pragma once

#include "domelight/image/repair_report.h"
#include "domelight/image/image.h"
#include "domelight/base/vec.h"

#include <array>
#include <optional>
#include <span>

namespace domelight {

/// The largest radiance that readers hand on. No light comes near it, and sums over the brightest thinkable image stay
/// finite in float.
inline constexpr float k_largest_radiance = 0x1p100f;

/// How to turn stored texels into radiance: finite, in [0, k_largest_radiance], linear Rec. 709.
struct RepairOptions {
    float largest = k_largest_radiance;  ///< the format's largest finite value: what infinity becomes, before `scale`
    std::optional<Mat3> to_rec709 = std::nullopt;  ///< the file's primaries to Rec. 709
    float scale = 1;                               ///< exposure
    bool wraps = true;                             ///< the row's ends are neighbours (lat-long)
};

/// Mends one row of RGB texels in place and counts in `report`. In this order: a texel with a NaN becomes the mean of
/// the nearest texels without one to its left and right (0 where the row has none); infinities become `largest`
/// (-infinity 0); then the primaries and the scale; negative channels become 0; and what passes k_largest_radiance is
/// cut to it and counted with the infinities.
void repair_row(std::span<float> rgb, const RepairOptions& options, RepairReport& report);

/// Adds the counts of `part` to `sum`; warnings stay.
void add_repairs(RepairReport& sum, const RepairReport& part);

}  // namespace domelight
