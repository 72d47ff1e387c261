#pragma once

#include "domelight/io/environment/open_environment.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include "cli/console/console.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// The options of `domelight sample`.
struct SampleWords {
    CommonOptions common;
    std::vector<std::string> inputs;
    EnvironmentOptions environment;

    std::optional<int> count;
    std::string output, method = "bilinear", weight = "radiant-power", sequence = "sobol";
    std::string seed = "1";
    bool compensate = false;
    double uniform_share = 0;

    std::string picture, heat, heat_measure = "solid-angle", tables, tables_format = "ktx2";
    std::optional<int> picture_width;

    bool estimate = false;
    std::string plot, brdf = "lambert";
    std::vector<std::string> strategies;  ///< names of those to compare; empty: all
    std::vector<double> normal{0, 1, 0}, view, metal_f0{1};
    double roughness = 0.3, exponent = 32;

    std::vector<double> explain;
    std::string explain_picture;

    // Set by check_sample_options() from the words.
    EnvironmentSamplerOptions sampler;
    Sequence points = Sequence::sobol;
    std::uint64_t seed_number = 1;
    Vec3d normal_world, view_world;  ///< unit length

    int threads() const { return common.threads.value_or(0); }
    std::string environment_name() const;
};

void declare_sample_options(Arguments& arguments, SampleWords& words);
/// Checks the values and their combinations, and sets the members that follow from them. Errors name the option.
Result<void> check_sample_options(const Arguments& arguments, SampleWords& words);

/// "bilinear-plain" for DistributionMethod::bilinear_plain: names on the command line have dashes.
std::string method_word(DistributionMethod method);

}  // namespace domelight::cli
