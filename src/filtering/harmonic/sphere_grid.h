#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include "base/aligned.h"
#include "filtering/harmonic/bright_split.h"
#include "filtering/harmonic/grid_lookup.h"
#include "filtering/harmonic/ring_grid.h"
#include "filtering/kernel/residual_kernel.h"
#include "filtering/lights/light_groups.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace domelight {

/// A band-limited RGB function on the rings of a grid, with the surroundings (wrapped columns, rings beyond the poles)
/// that interpolation reads.
class SphereGrid {
  public:
    static constexpr int k_pad = 4;

    /// zeroed   whether the function is 0 at first; else it is undefined
    explicit SphereGrid(RingGrid grid, bool zeroed = true);

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

/// The lookup's weights for functions whose band limit is `band` times the number of rings. Tables are kept: one takes as
/// long as the lookup of a small face.
std::shared_ptr<const simd::TapTable> lookup_table(double band);

/// What the tapered expansion of a kernel lacks of a few lights: the residual kernel summed over them, wherever it
/// matters.
class ResidualLights {
  public:
    /// least   of each channel, the value below which a texel's error is held against this value instead
    ResidualLights(const LightGroups& groups, const ResidualKernel& kernel, const Vec3d& least);
    simd::ResidualTable table() const { return kernel_.table(); }
    simd::ResidualGroups view() const;

  private:
    const LightGroups& groups_;
    const ResidualKernel& kernel_;
    std::vector<float> ring_limit_, axis_limit_;
};

/// What a lookup adds to each texel.
struct LookupOptions {
    double band = 0.7;  ///< band limit over the number of rings
    Mat3 world_to_source;
    int threads = 0;
    /// The part of the brightest texels that the tapered expansion lacks. Null: none.
    const ResidualLights* residual = nullptr;
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
