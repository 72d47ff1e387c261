#pragma once

#include "domelight/sampling/environment_sampler.h"

#include "cli/sample/sample_options.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// Writes the samples to --output, as its ending says; where there is none, to stdout, as CSV or with --json as one
/// document. Drawn one by one as they are written, so that any number fits.
Result<void> write_samples(const SampleWords& words, const EnvironmentSampler& sampler, const Progress& progress);

/// What write_tables() wrote.
struct SamplingTables {
    std::vector<std::string> files = {};  ///< names in the folder
    double total_average = 0;             ///< SamplingTextures::total_average
};

/// The tables for shaders, rows.*, columns.* and row_averages.* in the folder of --tables: all appear or none.
Result<SamplingTables> write_tables(const SampleWords& words, const EnvironmentSampler& sampler);

}  // namespace domelight::cli
