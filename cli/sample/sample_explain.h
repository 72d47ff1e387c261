#pragma once

#include "domelight/study/sample_explanation.h"

#include "cli/sample/sample_estimate.h"

namespace domelight::cli {

/// The explanation that --explain asks for, step by step. Also writes the file of --explain-picture if there is one.
Result<Told> told_explanation(const SampleWords& words, const EnvironmentSampler& sampler);

}  // namespace domelight::cli
