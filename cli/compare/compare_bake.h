#pragma once
// domelight compare --bake THEIRS --env SRC: anybody's baked specular cube against the exact filter.

#include "domelight/io/environment/open_environment.h"

#include "cli/console/arguments.h"
#include "cli/console/console.h"

#include <string>
#include <vector>

namespace domelight::cli {

struct BakeWords {
    std::vector<std::string> bake, env;
    std::string engine;
    EnvironmentOptions environment;
    std::optional<int> texels;
};
void add_bake_options(Arguments& arguments, BakeWords& words);

/// Audits and prints. Returns the exit code.
int compare_bake(const BakeWords& words, const CommonOptions& common);

}  // namespace domelight::cli
