#pragma once

#include "cli/render/render_options.h"

namespace domelight::cli {

/// `render --study`: three figures into a folder with their numbers (study.json), or onto one sheet. `scene`: the
/// user's, or none for the study's own. Prints what was done; the exit code.
int run_study(const RenderWords& words, std::optional<Scene> scene, const Environment& environment);

}  // namespace domelight::cli
