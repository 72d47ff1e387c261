#pragma once
// Which way of choosing light directions is best on one surface: every strategy of reflection_estimate.h, run many
// times.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/sampling/reflection_estimate.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace domelight {

struct StrategyStudyOptions {
    std::variant<LambertBrdf, PhongBrdf, GgxBrdf, CharlieBrdf> brdf = LambertBrdf{};
    Vec3d normal{0, 1, 0};  ///< of the surface, world, unit length
    Vec3d view{0, 1, 0};    ///< towards the viewer, world, unit length, not below the surface
    int samples = 4096;     ///< the most that a strategy gets, at least 1
    Sequence sequence = Sequence::random;
    std::uint64_t seed = 1;  ///< of the first run
    /// Names out of studied_strategies(); empty: all. "environment" always runs.
    std::vector<std::string> strategies = {};
    int threads = 0;  ///< 0: all
    Progress progress = {};
};
/// MIS by the balance heuristic with the compensated density.
inline constexpr const char* k_compensated_mis = "mis-balance-compensated";
/// The names of every Strategy, and k_compensated_mis.
const std::vector<std::string>& studied_strategies();

/// The results of one strategy.
struct StrategyResult {
    std::string name;        ///< one of studied_strategies()
    Estimate estimate;       ///< of the first run
    double error = 0;        ///< RMS over the runs of the luminance's error, over the reference's luminance
    double slope = 0;        ///< of log error over log N, least squares; NaN with fewer than two points
    double cpu_seconds = 0;  ///< of one run
    std::vector<std::array<double, 2>> curve;  ///< (N, error)
    /// Variance of one sample over the squared luminance, as an integral (see study_strategies()). Only for strategies
    /// of one density on random points.
    std::optional<double> variance;
    double expected_error() const { return variance ? std::sqrt(*variance / estimate.samples) : error; }
    /// Whether the runs met so little of the light that their measured error is far too small.
    bool missed() const { return expected_error() > 1.5 * error; }
    double efficiency = 0;       ///< 1 / (variance x CPU time), that of environment sampling being 1; may be infinite
    double for_one_percent = 0;  ///< samples until the error is 1 %; infinite where more samples do not help
};

struct StrategyStudy {
    Vec3d reference;
    Vec3d reference_error;  ///< standard error of the reference; 0: exact
    std::string reference_method;
    int samples = 0;
    int runs = 0;        ///< with so many samples; up to four times as many with fewer samples
    int candidates = 8;  ///< of Strategy::product, for each direction kept
    std::vector<StrategyResult> strategies;

    const StrategyResult* find(const std::string& name) const;  ///< null where it was not studied
    /// Efficiency of `name` over that of `than`; NaN where one of the two was not studied.
    double efficiency_ratio(const std::string& name, const std::string& than) const;
    /// How many directions drawn from the environment one direction kept by Strategy::product is worth, where the
    /// shadow ray is the whole cost; 0: unknown.
    double product_gain_per_ray() const;
};

/// Runs every strategy many times over at growing N. Errors: options out of range; "cancelled"; no light to
/// reflect; those of building a sampler.
///
/// A strategy that seldom meets the sun looks better than it is in any few runs. So for those of one density p, on
/// random points, the variance is computed and not measured: int (f L cos)^2 / p dL - (int f L cos dL)^2, the first by
/// multiple importance sampling.
Result<StrategyStudy> study_strategies(const EnvironmentSampler& sampler, const StrategyStudyOptions& options = {});

}  // namespace domelight
