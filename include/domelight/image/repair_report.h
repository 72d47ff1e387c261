#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// Bad texels that a reader found and repaired. The report is complete once all rows have been read.
struct RepairReport {
    /// Texels with a NaN channel: all their channels are set to the mean of the nearest texels without a NaN to the
    /// left and to the right on the row (around the seam of a lat-long image), or to 0 if the row has none.
    std::int64_t not_a_number = 0;
    /// Texels with a channel that is infinite or, after the exposure, above 2^100: +infinity is set to the largest
    /// finite value of the format, -infinity to 0, larger values to 2^100.
    std::int64_t infinite = 0;
    std::int64_t negative = 0;          ///< texels with a negative channel: the channel set to 0
    double negative_radiance = 0;       ///< the most negative value found
    std::vector<std::string> warnings;  ///< "PNG is not HDR: values above 1 are clipped", ...
    std::int64_t repaired() const { return not_a_number + infinite + negative; }
};

}  // namespace domelight
