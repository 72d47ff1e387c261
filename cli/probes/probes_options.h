#pragma once

#include "domelight/capture/capture.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/probe/probe.h"
#include "domelight/texture/texture.h"

#include "cli/console/arguments.h"
#include "cli/console/console.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

/// The command line of `probes`.
struct ProbesWords {
    CommonOptions common;
    std::vector<std::string> scenes, environment_files, light_files, at, engines;
    EnvironmentOptions environment;
    std::string output, check;
    std::vector<double> grid, region;
    double density = 0, noise = 0, budget = 0, lux_per_unit = 683;
    double nearest = 0, farthest = -1;  ///< not given: 0, and -1
    std::optional<int> auto_count, size, spp, bounces, seed, levels, irradiance_size, distance_size;
    Encoding encoding = Encoding::rgb9e5;

    std::string influence = "everywhere", proxy = "room";

    // Set by check_words().
    std::vector<Vec3f> places;  ///< `at`
    ProbeInfluence::Shape shape = ProbeInfluence::Shape::everywhere;
    float radius = 0;             ///< of a sphere of influence
    std::optional<ProbeBox> box;  ///< `proxy`, where it is stated

    int threads() const { return common.threads.value_or(0); }
    std::string scene_name() const { return scenes.empty() ? "" : scenes.front(); }
    CaptureOptions capture() const;
};

/// Checks the options and their combinations.
Result<void> check_words(ProbesWords& words, const Arguments& arguments);

}  // namespace domelight::cli
