#pragma once

#include "domelight/scene/scene.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"

#include <string>

namespace domelight {

/// Reads the option `scene`, the name of a built-in scene.
void read_scene_option(OptionReader& reader, std::string& scene);

/// The scene of a job: the file of its input "scene", or the built-in one. Errors: neither or both; those of reading.
Result<Scene> open_scene(const JobCall& call, const std::string& built_in, double lux_per_unit);

}  // namespace domelight
