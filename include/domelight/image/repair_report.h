#pragma once

#include "domelight/base/vec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// Bad texels that a reader found and repaired. The report is complete once all rows have been read.
struct RepairReport {
    /// Texels with a NaN channel: all their channels are set to the mean of the nearest texels without a NaN to the
    /// left and to the right on the row (around the seam of a lat-long image), or between the nearest rows above and
    /// below where the row has none; to 0 where there is no such texel at all.
    std::int64_t not_a_number = 0;
    /// Texels with a channel that is infinite or, after the exposure, above 2^100. +infinity is set to the largest
    /// finite value of the format (65504 for half floats), or, of 32-bit floats, to the largest finite value near it;
    /// -infinity to 0; larger values to 2^100.
    std::int64_t infinite = 0;
    std::int64_t negative = 0;     ///< texels with a negative channel, which became 0 unless they were to be kept
    double negative_radiance = 0;  ///< the most negative value found
    bool negatives_kept = false;   ///< because that was asked for
    /// The light of the file's finite values, negative ones included, and what repairing added to it: radiance times
    /// solid angle (lat-long images) or summed over texels. Both are 0 where no repair was possible or needed.
    Vec3d light, added;
    std::vector<std::string> warnings;  ///< "PNG is not HDR: values above 1 are clipped", ...
    std::int64_t repaired() const { return not_a_number + infinite + negative; }
    /// `added` as a share of `light`, for each channel: 0.01 is 1 % more light than the file has. 0 where there is no
    /// light.
    Vec3d share_added() const;
    /// The warnings, and a sentence on the bad texels and the light that their repair added or took if there are any.
    std::vector<std::string> lines() const;
};

}  // namespace domelight
