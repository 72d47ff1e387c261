#pragma once

#include "domelight/render/render.h"

#include "cli/render/render_job.h"

#include <string>
#include <vector>

namespace domelight::cli {

/// Measures pictures for the exposure that suits them. Pictures that are to share one exposure are added in turn.
class ExposureMeter {
  public:
    /// `background_shows`: behind the surfaces, in their pixels' radiance.
    void add(const RenderResult& picture, bool background_shows);

    /// Stops that bring the log-average luminance of what surfaces show to 0.18 (Reinhard et al. 2002); of the whole
    /// picture where it shows none. What is darker than a thousandth of the mean counts as that. But no more stops than
    /// leave 95 % of the lit surfaces, and half of the background that shows, below the luminance 4: a picture that is
    /// mostly dark does not burn what is lit in it.
    double ev() const;

  private:
    struct Shown {
        double luminance = 0;
        double weight = 0;  ///< the part of the pixel that shows it
    };
    static double mean(const std::vector<Shown>& shown);
    static double quantile(std::vector<Shown> shown, double part, double darkest);

    std::vector<Shown> surfaces_, background_;
    double pixels_ = 0;
};

/// ", exposure +1.25 EV" where a picture for a screen is written, and else nothing.
std::string exposure_text(const RenderWords& words, double ev);

/// The picture as a display shows it: 3 channels, 4 with --background transparent.
Image<std::uint8_t> display_picture(const RenderResult& picture, const RenderWords& words, double ev);

/// Writes it as the file's ending says: .png (tone mapped), .hdr, .exr (all layers).
Result<void> write_picture(const std::string& file, const FinishedPicture& picture, const Scene& scene,
                           const RenderWords& words);
/// To all of them; the error names the file.
Result<void> write_pictures(const std::vector<std::string>& files, const FinishedPicture& picture, const Scene& scene,
                            const RenderWords& words);

}  // namespace domelight::cli
