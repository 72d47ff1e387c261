#pragma once

#include "domelight/study/sample_explanation.h"

#include "cli/sample/sample_estimate.h"

namespace domelight::cli {

/// The explanation that --explain asks for, step by step. Also writes the file of --explain-picture if there is one.
Result<Told> told_explanation(const SampleWords& words, const EnvironmentSampler& sampler);

/// The environment with the row and the sample drawn on it, the marginal density beside it and the row's conditional
/// density below. 8-bit sRGB.
Image<std::uint8_t> explanation_picture(const EnvironmentSampler& sampler, const SampleExplanation& explanation,
                                        const std::string& title, int threads);

}  // namespace domelight::cli
