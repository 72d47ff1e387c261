#pragma once
// All figures of the difference of two pictures, as `domelight compare A B` prints them.

#include "domelight/base/progress.h"
#include "domelight/compare/metrics.h"
#include "domelight/compare/picture_reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace domelight {

/// A picture, and the reference that it is compared with.
struct PicturePair {
    Picture test, reference;    ///< of the same size
    ImageF mask;                ///< one channel, > 0 where a pixel counts; empty: everywhere
    std::int64_t left_out = 0;  ///< pixels that without_bad_pixels() excluded, of those that counted
    Mask mask_view() const { return mask.empty() ? Mask{} : Mask(mask.view()); }
    /// Whether a picture holds radiance. Two pictures for a screen have no HDR-FLIP.
    bool high_dynamic_range() const { return test.high_dynamic_range || reference.high_dynamic_range; }
};

/// The pair without the pixels that are NaN or infinite in either picture: the mask excludes them, and both pictures
/// are black there, because FLIP and SSIM look at neighbours.
PicturePair without_bad_pixels(PicturePair pair);

struct PictureComparisonOptions {
    bool flip = true;  ///< also FLIP and, of radiance, HDR-FLIP, which take most of the time
    FlipOptions flip_options = {};
    /// Stops by which both pictures are exposed for FLIP. Nothing: those that bring the log-average luminance of the
    /// reference to 0.18, or 0 if both pictures are for a screen.
    std::optional<double> exposure_ev = {};
    int threads = 0;  ///< 0: all
    /// Called before each stage. Its return value is ignored, so a comparison cannot be cancelled.
    Progress progress = {};
};

/// The figures of one object.
struct ObjectComparison {
    std::string name;  ///< from the picture; "background" for index 0, "object 7" where the picture has no name
    Errors errors;
    std::optional<double> flip, hdr_flip;  ///< means over the object, where the whole picture has them
};

struct PictureComparison {
    Errors errors;
    double exposure_ev = 0;                ///< of FLIP
    std::optional<double> flip, hdr_flip;  ///< means over the pixels that count
    ImageF flip_map;                       ///< FLIP of each pixel; empty without `flip`
    HdrFlip hdr;                           ///< HDR-FLIP of each pixel; empty without `hdr_flip`
    std::optional<NoiseSummary> noise;     ///< where a picture has a variance
    /// In the order of the indices; empty if neither picture has object indices. Those of the reference are used if it
    /// has any.
    std::vector<ObjectComparison> objects;
};
/// Compares finite pictures of one size (see without_bad_pixels()).
PictureComparison compare_pictures(const PicturePair& pair, const PictureComparisonOptions& options = {});

/// The names of the figures: rmse, relative, tone-mapped, largest, psnr, ssim, flip, hdr-flip, mean, above-2, chi2,
/// total-z.
const std::vector<std::string>& comparison_figures();
/// A figure by its name, from `errors`, `noise` or FLIP; "mean" is |mean_ratio - 1|, "total-z" is |total_z|. Empty if
/// these pictures have no such figure.
std::optional<double> comparison_figure(const PictureComparison& comparison, std::string_view name);

}  // namespace domelight
