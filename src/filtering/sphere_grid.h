#pragma once

#include <vector>

#include "core/aligned.h"
#include "domelight/image.h"
#include "domelight/vec.h"
#include "filtering/ring_grid.h"
#include "simd/grid_lookup.h"

namespace domelight {

/// A band-limited RGB function on the rings of a grid, with the surroundings (wrapped columns, rings beyond the poles) that interpolation reads.
class SphereGrid {
  public:
    static constexpr int k_pad = 4;

    explicit SphereGrid(RingGrid grid);

    const RingGrid& grid() const { return grid_; }
    float* ring(int k) { return data_.data() + (k + k_pad) * stride_ + 4 * k_pad; }
    const float* ring(int k) const { return data_.data() + (k + k_pad) * stride_ + 4 * k_pad; }
    simd::GridView view() const { return {ring(0), stride_, grid_.rings, grid_.width}; }
    /// Fills the surroundings from the rings.
    void wrap();

  private:
    RingGrid grid_;
    std::ptrdiff_t stride_;
    AlignedArray<float> data_;  ///< RGBX
};

/// The grid's function at the texel centres of a cube or lat-long image. `band`: band limit over the number of rings. Negative values are set to 0
/// and their number added to `clamped`.
Cubemap grid_to_cube(const SphereGrid& grid, double band, int size, const Mat3& world_to_source, int threads, std::int64_t& clamped);
ImageF grid_to_latlong(const SphereGrid& grid, double band, int height, const Mat3& world_to_source, int threads, std::int64_t& clamped);

}  // namespace domelight
