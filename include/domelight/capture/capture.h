#pragma once
// The light at many points of a scene, by path tracing.

#include "domelight/base/progress.h"
#include "domelight/image/image.h"
#include "domelight/render/render.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace domelight {

struct CaptureOptions {
    int size = 64;            ///< texels along a face, 8 .. 1024
    int samples = 32;         ///< of each texel, 1 .. 2^20
    double noise = 0;         ///< > 0: texels get more samples while the standard error of L / (1 + L) is above this
    int most_samples = 1024;  ///< of a texel where `noise` is above 0
    int bounces = 3;          ///< of indirect light, 0 .. 1000
    /// Lights that were taken out of the environment (load_environment_lights): they light the scene beside its own.
    std::vector<PunctualLight> environment_lights;
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress;
};

/// What a probe sees.
struct CapturedCube {
    Cubemap radiance;  ///< RGB
    /// One channel each: the mean distance to the surfaces that a texel shows in metres, and the part of the texel that
    /// they cover, 0 .. 1. The distance is 0 where there are none.
    Cubemap depth, coverage;
    std::int64_t rays = 0;
    std::int64_t non_finite_samples = 0;  ///< they count as black
};

/// Captures the light at each position and hands the cubes over in order, a few at a time, so that the memory does not
/// depend on how many there are. The bits are the same on any number of threads, and those of a position depend on
/// its own number alone.
///
/// numbers  of the probes at `positions`: each has random numbers of its own
/// use      called with the index of a position and its cube, from several threads at once. An error ends the capture
///
/// Errors: an option out of its range; "cancelled"; those of `use`.
Result<void> capture(const RayScene& scene, const EnvironmentSampler& sampler, std::span<const Vec3f> positions,
                     std::span<const int> numbers, const CaptureOptions& options,
                     const std::function<Result<void>(int index, CapturedCube cube)>& use);

}  // namespace domelight
