#pragma once

#include "cli/sample/sample_estimate.h"
#include "cli/sample/sample_explanation.h"

namespace domelight::cli {

/// The explanation that --explain asks for, as a lecturer would put it on the board; writes --explain-picture.
Result<Told> explain_sample(const SampleWords& words, const EnvironmentSampler& sampler);

/// The environment with the row and the point on it, the marginal beside it, the row's conditional below; 8-bit sRGB.
Image<std::uint8_t> explanation_picture(const EnvironmentSampler& sampler, const Explanation& explanation,
                                        const std::string& title, int threads);

}  // namespace domelight::cli
