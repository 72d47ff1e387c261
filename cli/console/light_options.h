#pragma once

#include "domelight/io/environment/open_environment.h"
#include "domelight/scene/scene.h"

#include "cli/console/console.h"

#include <string>
#include <vector>

namespace domelight::cli {

inline constexpr const char* k_lights_help =
    "lights that were taken out of the environment: lights.gltf of `domelight lights`, whose remainder is --env; they "
    "turn with --rotate-y-deg and brighten with --exposure as the environment does";

/// A light of the environment after the environment has been turned about the origin.
PunctualLight turned_light(PunctualLight light, const Mat3& turn);

/// The lights of the files of --lights, turned and brightened as the environment is. Warns of files without lights.
Result<std::vector<PunctualLight>> environment_lights(const std::vector<std::string>& files,
                                                      const EnvironmentOptions& environment,
                                                      const SceneOptions& options, const CommonOptions& common);

}  // namespace domelight::cli
