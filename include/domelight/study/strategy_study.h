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
    /// Names from studied_strategies(); empty: all. "environment" always runs.
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
    /// The RMS error that follows from `variance`; `error` where that is not known.
    double expected_error() const { return variance ? std::sqrt(*variance / estimate.samples) : error; }
    /// Whether the measured error is too small, below 2/3 of expected_error(), because the runs seldom hit the bright
    /// light.
    bool missed() const { return expected_error() > 1.5 * error; }
    double efficiency = 0;       ///< 1 / (variance x CPU time), that of environment sampling being 1; may be infinite
    double for_one_percent = 0;  ///< samples until the error is 1 %; infinite where more samples do not help
};

struct StrategyStudy {
    Vec3d reference;
    Vec3d reference_error;  ///< standard error of the reference; 0: exact
    std::string reference_method;
    int samples = 0;
    int runs = 0;        ///< number of runs with `samples` samples; up to four times as many at smaller sample counts
    int candidates = 8;  ///< of Strategy::product, for each direction kept
    std::vector<StrategyResult> strategies;

    const StrategyResult* find(const std::string& name) const;  ///< null where it was not studied
    /// Efficiency of `name` over that of `than`; NaN where one of the two was not studied.
    double efficiency_ratio(const std::string& name, const std::string& than) const;
    /// The number of samples of Strategy::environment that have the same error as one sample kept by Strategy::product:
    /// the gain if shadow rays are the only cost. 0: unknown.
    double product_gain_per_ray() const;
};

/// Runs every strategy many times over at growing N. Errors: options out of range; "cancelled"; no light to
/// reflect; those of building a sampler.
///
/// A few runs underestimate the error of a strategy that seldom samples the sun. For strategies with a single density p
/// on random points the variance is therefore computed and not measured: int (f L_i cos)^2 / p dw - (int f L_i cos
/// dw)^2 over the solid angle w, the first integral by multiple importance sampling.
Result<StrategyStudy> study_strategies(const EnvironmentSampler& sampler, const StrategyStudyOptions& options = {});

}  // namespace domelight
