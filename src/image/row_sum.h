#pragma once

#include "domelight/base/vec.h"

#include <cstddef>
#include <span>

namespace domelight {

/// The sum of a row of RGB texels. Four independent sums for each channel, so that additions overlap; four floats are
/// added in single precision before they join a sum.
inline Vec3d row_sum(std::span<const float> rgb) {
    double sum[12] = {};
    const float* p = rgb.data();
    const int n = int(rgb.size());
    int i = 0;
    for (; i + 48 <= n; i += 48)
        for (int k = 0; k < 12; ++k) sum[k] += (p[i + k] + p[i + 12 + k]) + (p[i + 24 + k] + p[i + 36 + k]);
    for (int k = 0; i < n; ++i, k = (k + 1) % 3) sum[k] += p[i];
    return {sum[0] + sum[3] + sum[6] + sum[9], sum[1] + sum[4] + sum[7] + sum[10], sum[2] + sum[5] + sum[8] + sum[11]};
}

}  // namespace domelight
