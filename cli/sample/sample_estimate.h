#pragma once

#include "domelight/base/progress.h"
#include "domelight/sampling/environment_sampler.h"

#include "cli/sample/sample_options.h"
#include "io/file/json.h"

#include <string>

namespace domelight::cli {

/// The result of one part of `domelight sample`, as text and as JSON.
struct Told {
    std::string text;
    Json json;
};

/// The table of all strategies. Also writes the file of --plot if there is one.
Result<Told> estimate_by_all_strategies(const SampleWords& words, const EnvironmentSampler& sampler,
                                        const Progress& progress);

}  // namespace domelight::cli
