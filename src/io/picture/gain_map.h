#pragma once

#include "domelight/image/rgba8_image.h"

#include "io/picture/jpeg_segments.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// How the codes of a gain map change the light of the picture that it belongs to.
struct GainMapFormula {
    std::string kind;          ///< "ISO 21496-1", "Ultra HDR", "Apple"
    bool base_is_hdr = false;  ///< the gain map leads from HDR to a screen: there is nothing to apply
    bool apple = false;        ///< light times 1 + (headroom - 1) * map; otherwise the rest counts
    double headroom = 1;
    bool in_other_colours = false;  ///< the gain is meant in the colours of the HDR picture, not in those of the base
    /// log2 of the gain where the map is 0 and 1, and the power to which the map was raised, for each channel.
    std::array<double, 3> least{0, 0, 0}, most{0, 0, 0}, gamma{1, 1, 1};
    /// Added to the light before the gain, and taken from it after that.
    std::array<double, 3> offset_base{0, 0, 0}, offset_hdr{0, 0, 0};
};

/// A JPEG's gain map.
class GainMap {
  public:
    GainMap(GainMapFormula formula, Rgba8Image codes);
    const GainMapFormula& formula() const { return formula_; }
    /// The greatest light of a picture whose white is 1.
    double largest() const;
    /// Applies it to row y of `height` rows of a picture's linear light, white being 1. The map is read between its
    /// texels, as it may be coarser than the picture.
    void apply(float* rgb, int width, int y, int height) const;

  private:
    double applied(double light, int c, double code) const;

    GainMapFormula formula_;
    Rgba8Image codes_;
};

/// The gain map in a JPEG file, whose segments are given: by ISO 21496-1, by Adobe's and Google's XMP (hdrgm) or by
/// Apple's. Nothing if there is none. `note`: why one that is there cannot be read.
std::optional<GainMap> find_gain_map(std::span<const std::uint8_t> file, const std::vector<JpegSegment>& segments,
                                     std::string& note);

/// The same from the segments of the gain map's own JPEG, and of the picture's.
std::optional<GainMapFormula> gain_map_formula(const std::vector<JpegSegment>& map,
                                               const std::vector<JpegSegment>& picture);

}  // namespace domelight
