#pragma once

#include "cli/render/render_options.h"

namespace domelight::cli {

/// `render --study`: writes three figures and their numbers (study.json) into a folder, or the figures onto one sheet.
/// `scene`: the user's, or none for the study's own. Prints what was done and returns the exit code.
int run_study(const RenderWords& words, std::optional<Scene> scene, const Environment& environment);

}  // namespace domelight::cli
