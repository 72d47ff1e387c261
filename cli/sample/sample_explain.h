#pragma once

#include "domelight/study/sample_explanation.h"

#include "cli/sample/sample_estimate.h"

namespace domelight::cli {

/// The explanation that --explain asks for, as a lecturer would put it on the board; writes --explain-picture.
Result<Told> told_explanation(const SampleWords& words, const EnvironmentSampler& sampler);

/// The environment with the row and the point on it, the marginal beside it, the row's conditional below; 8-bit sRGB.
Image<std::uint8_t> explanation_picture(const EnvironmentSampler& sampler, const SampleExplanation& explanation,
                                        const std::string& title, int threads);

}  // namespace domelight::cli
