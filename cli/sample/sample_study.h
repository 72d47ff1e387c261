#pragma once

#include "domelight/base/progress.h"
#include "domelight/sampling/reflection_estimate.h"

#include "cli/sample/sample_options.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// How one strategy did.
struct StrategyResult {
    std::string name;        ///< as strategy_name(), with "-compensated" where the density was
    Estimate estimate;       ///< the first run, with the seed that was asked for
    double error = 0;        ///< RMS over the runs of the luminance's error, over the reference's luminance
    double slope = 0;        ///< of log error over log N, least squares; NaN with fewer than two points
    double cpu_seconds = 0;  ///< of a run, this thread's time
    std::vector<std::array<double, 2>> curve;  ///< (N, error)
    /// Variance of one sample over the squared luminance, as an integral (see below); only for one-density strategies
    /// on random points.
    std::optional<double> variance;
    double expected_error() const { return variance ? std::sqrt(*variance / estimate.samples) : error; }
    /// Whether the runs met so little of the light that their error says nothing.
    bool missed() const { return expected_error() > 1.5 * error; }
    double efficiency = 0;       ///< 1 / (variance x CPU time), environment sampling's taken as 1; may be infinite
    double for_one_percent = 0;  ///< samples until the error is 1 %; infinite where more do not help
};

struct Study {
    Vec3d reference;
    Vec3d reference_error;  ///< its own standard error; 0: exact
    std::string reference_method;
    int samples = 0;
    int runs = 0;        ///< with so many samples; with fewer up to four times as many
    int candidates = 8;  ///< of the product form, for each direction kept
    std::vector<StrategyResult> strategies;
    const StrategyResult* find(const std::string& name) const;
};

/// Runs every strategy many times over at growing N. Errors: cancelled, no light to reflect.
///
/// A strategy that seldom meets the sun looks better than it is in any few runs. So for those of one density p, on
/// random points, the variance is computed and not measured: int (f L cos)^2 / p dL - (int f L cos dL)^2, the first by
/// multiple importance sampling.
Result<Study> study_strategies(const SampleWords& words, const EnvironmentSampler& sampler, const Progress& progress);

}  // namespace domelight::cli
