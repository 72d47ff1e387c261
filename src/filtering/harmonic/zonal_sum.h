#pragma once

#include <cstddef>

namespace domelight::simd {

/// Point lights on the sphere: unit directions and RGB powers (radiance times solid angle).
struct PointSet {
    const float *x, *y, *z, *r, *g, *b;
    int count;
};

/// A function of the angle between two directions, linear between table[i] = f(pi i / steps), i = 0..steps (and one
/// more entry after it).
struct ZonalTable {
    const float* values;
    int steps;
};

/// rgb[3 i + c] += sum_p f(angle(direction_i, p)) power_p[c] for `count` unit directions.
void add_zonal_sum(const PointSet& points, const ZonalTable& table, const float* x, const float* y, const float* z,
                   int count, float* rgb);

}  // namespace domelight::simd
