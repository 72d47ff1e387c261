#pragma once

#include "domelight/image/image.h"
#include "domelight/base/progress.h"
#include "domelight/environment/environment.h"
#include "domelight/base/result.h"
#include "domelight/image/row_source.h"
#include "domelight/base/vec.h"
#include "domelight/filtering/kernel/zonal_kernel.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

enum class Layout { cube, latlong };

/// One level of a specular chain.
struct LevelSpec {
    int size = 0;         ///< cube: face size; lat-long: height (the width is twice that)
    bool mirror = false;  ///< the environment itself, averaged over each texel; `kernel` is then ignored
    ZonalKernel kernel;
};

/// What to compute from an environment.
struct FilterOptions {
    Layout layout = Layout::cube;
    std::vector<LevelSpec> specular;
    int irradiance_size = 0;  ///< face size (cube) or height (lat-long); 0: none
    int sh_bands = 3;         ///< spherical harmonics of the radiance, this many bands; 0: none
    /// Where to look in the source for the light from a world direction. For an Environment, which brings a
    /// world_to_source of its own, this one is applied before it: it then turns the world.
    Mat3 world_to_source;
    int threads = 0;          ///< 0: all
    Progress progress;
};

/// A level of filtered light, in either layout (the other one is empty). RGB float32 radiance.
struct FilteredMap {
    Cubemap cube;
    ImageF latlong;
    std::span<float> pixels() { return cube.empty() ? latlong.pixels() : cube.pixels(); }
    std::span<const float> pixels() const { return cube.empty() ? latlong.pixels() : cube.pixels(); }
};

struct FilterResult {
    std::vector<FilteredMap> specular;  ///< one for each LevelSpec
    FilteredMap irradiance_over_pi;     ///< E / pi
    /// Radiance coefficients a_lm, real orthonormal basis with the Condon-Shortley sign left out, order l^2 + l + m,
    /// world space (z is +Z): the axis of the basis is +Z as in Ramamoorthi and Hanrahan 2001; docs/conventions.md
    /// lists the polynomials.
    std::vector<Vec3d> sh;
    Vec3d mean;                ///< mean radiance over the sphere, of the bilinear reconstruction
    std::int64_t clamped = 0;  ///< texels whose truncation error was below zero, set to 0
    int band_limit = 0;        ///< highest degree that was used
};

/// The exact prefilter: every level is the environment convolved with its kernel, to about 1e-4. The source is the
/// bilinear reconstruction of the texels (u wraps, v clamps in the half rows at the poles). docs/math/prefilter.md.
/// Errors: what reading the source gives; "cancelled".
Result<FilterResult> prefilter(const Environment& environment, const FilterOptions& options);
/// The rows of a lat-long image, in the default convention up to FilterOptions::world_to_source. They are read once.
Result<FilterResult> prefilter(RowSource& source, const FilterOptions& options);
Result<FilterResult> prefilter(const Cubemap& source, const FilterOptions& options);

}  // namespace domelight
