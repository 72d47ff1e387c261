#pragma once

#include "domelight/image/image.h"

#include <vector>

namespace domelight {

/// Measures pictures for the exposure that suits them. Pictures that are to share one exposure are added in turn.
class ExposureMeter {
  public:
    /// Pixels that are not finite are left out; of more than four million pixels some stand for all.
    ///
    /// rgb      3 channels, linear radiance
    /// opacity  1 channel, the part of each pixel that a surface covers (or how much it counts); empty: all of each
    /// premultiplied  `rgb` has been multiplied with the opacity: no background shows in the rest of a pixel
    void add(ImageView<const float> rgb, ImageView<const float> opacity, bool premultiplied);

    /// Stops that bring the log-average luminance of what surfaces show to 0.18 (Reinhard et al. 2002, eq. 1); of the
    /// whole picture where it shows none. What is darker than a thousandth of the mean counts as that. But no more stops
    /// than leave 95 % of the lit surfaces, and half of the background that shows, below the luminance 4: a picture that
    /// is mostly dark does not burn what is lit in it. 0 for a black picture.
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

}  // namespace domelight
