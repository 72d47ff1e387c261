#pragma once

#include "domelight/engines/engine.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include "cli/console/console.h"
#include "preview/sample_picture.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// The options of `domelight sample`.
struct SampleWords {
    CommonOptions common;
    std::vector<std::string> inputs;
    EnvironmentOptions environment;

    std::optional<int> count;
    std::string output, seed = "1";
    Sequence sequence = Sequence::sobol;
    EnvironmentSamplerOptions sampler;

    std::string picture, heat, tables;
    DensityMeasure heat_measure = DensityMeasure::solid_angle;
    Container tables_format = Container::ktx2;
    std::optional<int> picture_width;

    bool estimate = false;
    std::string plot, brdf = "lambert";
    std::vector<std::string> strategies;  ///< names of those to compare; empty: all
    std::vector<double> normal{0, 1, 0}, view, metal_f0{1};
    double roughness = 0.3, exponent = 32;

    std::vector<double> explain;
    std::string explain_picture;

    // Set by check_sample_options() from the words.
    std::uint64_t seed_number = 1;
    Vec3d normal_world, view_world;  ///< unit length

    int threads() const { return common.threads.value_or(0); }
    std::string environment_name() const;
};

void declare_sample_options(Arguments& arguments, SampleWords& words);
/// Checks the values and their combinations, and sets the members that follow from them. Errors name the option.
Result<void> check_sample_options(const Arguments& arguments, SampleWords& words);

}  // namespace domelight::cli
