#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include "base/aligned.h"
#include "filtering/harmonic/bright_split.h"
#include "filtering/harmonic/grid_lookup.h"
#include "filtering/harmonic/ring_grid.h"

#include <cstdint>
#include <span>

namespace domelight {

/// A band-limited RGB function on the rings of a grid, with the surroundings (wrapped columns, rings beyond the poles)
/// that interpolation reads.
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

/// What a lookup adds to each texel.
struct LookupOptions {
    double band = 0.7;  ///< band limit over the number of rings
    Mat3 world_to_source;
    int threads = 0;
    /// The part that the truncated expansion lacks: a residual kernel summed over the brightest texels. Null: none.
    const BrightPoints* bright = nullptr;
    simd::ZonalTable residual{};
    /// Light that was removed before the expansion: a kernel summed over it. Null: none.
    const BrightSplit::Lights* lights = nullptr;
    simd::DirectKernel kernel{};
};

/// The grid's function at the texel centres of a cube or lat-long image. Negative values, which only truncation causes,
/// become 0; the number of texels with such values is added to `clamped`.
Cubemap grid_to_cube(const SphereGrid& grid, int size, const LookupOptions& options, std::int64_t& clamped);
ImageF grid_to_latlong(const SphereGrid& grid, int height, const LookupOptions& options, std::int64_t& clamped);
/// The same in single world directions, as one row.
ImageF grid_at_directions(const SphereGrid& grid, std::span<const Vec3d> directions, const LookupOptions& options,
                          std::int64_t& clamped);

}  // namespace domelight
