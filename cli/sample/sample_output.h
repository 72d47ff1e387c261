#pragma once

#include "domelight/sampling/environment_sampler.h"

#include "cli/sample/sample_options.h"

namespace domelight::cli {

/// Writes the samples to --output, as its ending says; where there is none, to stdout, as CSV or with --json as one
/// document. Drawn one by one as they are written, so that any number fits.
Result<void> write_samples(const SampleWords& words, const EnvironmentSampler& sampler, const Progress& progress);

/// The tables for shaders, DIR/rows.* and DIR/columns.*: both appear or neither. The names of the files.
Result<std::vector<std::string>> write_tables(const SampleWords& words, const EnvironmentSampler& sampler);

}  // namespace domelight::cli
