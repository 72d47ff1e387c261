#pragma once

#include "cli/render/render_job.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// "picture.png" to "picture_0001.png", frames counted from 1.
std::string frame_file(const std::string& file, int frame);

/// Draws --frames pictures while the camera, or the environment, goes once around the scene. Writes each into numbered
/// files, and an animation beside pictures for a screen. Prints what was done and returns the exit code.
int run_turntable(const RenderWords& words, const RayScene& scene, const EnvironmentSampler& sampler,
                  const EngineLight& light, const RenderOptions& options);

}  // namespace domelight::cli
