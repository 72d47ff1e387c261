#pragma once

#include "domelight/render/render.h"

#include "cli/render/render_job.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// ", exposure +1.25 EV" if a picture for a screen is written; otherwise nothing.
std::string exposure_text(const RenderWords& words, double ev);

/// The picture as a display shows it: 3 channels, 4 with --background transparent.
Image<std::uint8_t> display_picture(const RenderResult& picture, const RenderWords& words, double ev);

/// Writes the picture in the format of the file's ending: .png and .jpg (tone mapped), .hdr, .exr (all layers).
Result<void> write_picture(const std::string& file, const FinishedPicture& picture, const Scene& scene,
                           const RenderWords& words);
/// Writes the picture to all files. An error names the file.
Result<void> write_pictures(const std::vector<std::string>& files, const FinishedPicture& picture, const Scene& scene,
                            const RenderWords& words);

}  // namespace domelight::cli
