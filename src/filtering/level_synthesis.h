#pragma once

#include "domelight/filtering/prefilter.h"

#include "filtering/filter_plan.h"
#include "filtering/harmonic/bright_split.h"
#include "filtering/harmonic/ring_transform.h"
#include "filtering/harmonic/sh_synthesis.h"
#include "filtering/harmonic/spectrum.h"
#include "filtering/kernel/residual_kernel.h"
#include "filtering/lights/point_lights.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace domelight {

inline const Error k_cancelled{"cancelled", "", ""};

/// What the levels are made of.
struct SynthesisSource {
    /// The environment's brightest texels as point lights, fine enough for a band limit.
    using Bright = std::function<PointLights(int band_limit)>;

    Spectrum whole;
    Bright bright;
    /// If texels were removed for narrow lobes: the texels, and the spectrum without them.
    const BrightSplit* split = nullptr;
    Spectrum rest = {};
};

/// Levels of a group that are synthesised together, with what that needs besides the light.
struct LevelBatch {
    /// residuals   whether kernels that leave a residual are split
    LevelBatch(const FilterPlan::Group& group, std::span<const int> levels, const FilterOptions& options,
               bool residuals, std::shared_ptr<const RingTransform> transform);

    int band_limit;
    bool narrow;
    std::vector<int> levels;  ///< as FilterPlan::Group::levels
    /// Levels with the same kernel share a grid: the last one of most chains is the irradiance.
    std::vector<ZonalKernel> kernels;
    std::vector<std::size_t> kernel_of;  ///< of each level
    std::vector<SynthesisFactors> factors;
    std::vector<std::unique_ptr<const ResidualKernel>> residuals;
    std::shared_ptr<const RingTransform> transform;
};

/// All batches of a plan, for light that is filtered many times.
struct PreparedLevels {
    PreparedLevels(const FilterPlan& plan, const FilterOptions& options);

    /// The one for a band limit; those that were made before are used again.
    std::shared_ptr<const RingTransform> transform(int band_limit);

    std::vector<LevelBatch> batches;
    std::shared_ptr<const RingTransform> lights;  ///< null: no level leaves a residual

  private:
    std::vector<std::shared_ptr<const RingTransform>> transforms_;
};

Vec3d mean_radiance(const Spectrum& spectrum);

/// Fills the levels that are the environment itself from a cube.
void fill_mirror_levels(const Cubemap& source, const FilterOptions& options, FilterResult& result);

/// Everything that follows from the spectrum.
///
/// prepared   of the same plan and options; null: each batch is prepared when its turn has come
Result<void> make_levels(const SynthesisSource& source, const FilterPlan& plan, const FilterOptions& options,
                         FilterResult& result, const PreparedLevels* prepared = nullptr);

}  // namespace domelight
