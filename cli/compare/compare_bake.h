#pragma once
// domelight compare --bake THEIRS --env SRC: a specular cube baked by any tool, compared with the exact filter.

#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/io/environment/open_environment.h"

#include "cli/console/arguments.h"
#include "cli/console/console.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

struct BakeWords {
    std::vector<std::string> bake, env;
    std::string engine;
    std::optional<Lobe> lobe;  ///< nothing: what the file states, otherwise ggx
    EnvironmentOptions environment;
    std::optional<int> texels;
    bool as_read = false;
    double within = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given
};
void add_bake_options(Arguments& arguments, BakeWords& words);

/// Audits and prints. Returns exit_done where it is a bake of the environment, within the error asked for.
int compare_bake(const BakeWords& words, const CommonOptions& common);

}  // namespace domelight::cli
