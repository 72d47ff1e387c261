#pragma once

#include "domelight/sampling/environment_sampler.h"
#include "domelight/base/progress.h"

#include "io/file/json.h"
#include "cli/sample/sample_options.h"

#include <string>

namespace domelight::cli {

/// What a part of `domelight sample` has to say, in both forms.
struct Told {
    std::string text;
    Json json;
};

/// The table of all strategies; writes --plot where it is asked for.
Result<Told> estimate_by_all_strategies(const SampleWords& words, const EnvironmentSampler& sampler,
                                        const Progress& progress);

}  // namespace domelight::cli
