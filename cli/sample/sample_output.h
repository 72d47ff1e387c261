#pragma once

#include "domelight/sampling/environment_sampler.h"

#include "cli/sample/sample_options.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// Writes the samples to --output in the format of its ending; without --output to stdout, as CSV, or as one document
/// with --json. Each sample is drawn when it is written, so the memory does not limit their number.
Result<void> write_samples(const SampleWords& words, const EnvironmentSampler& sampler, const Progress& progress);

/// What write_tables() wrote.
struct SamplingTables {
    std::vector<std::string> files = {};  ///< names in the folder
    double total_average = 0;             ///< SamplingTextures::total_average
};

/// The tables for shaders, rows.*, columns.* and row_averages.* in the folder of --tables: either all of them appear or
/// none.
Result<SamplingTables> write_tables(const SampleWords& words, const EnvironmentSampler& sampler);

}  // namespace domelight::cli
