#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/io/decode.h"

#include "image/colour_primaries.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

// What the codes of a picture for a screen (PNG, JPEG) mean. Such pictures are accepted with a warning, because
// everything brighter than the screen's white was clipped when they were written.

/// How codes become light.
struct ScreenColour {
    std::array<std::vector<float>, 3> curves;  ///< the light of each code, for each channel; white is 1
    std::optional<Mat3> to_rec709;             ///< after the curves, where the file's primaries are others
    /// An ICC profile that is more than curves and a matrix: turns texels from shares of the greatest code, which the
    /// curves then hold, to linear Rec. 709.
    std::function<void(float* rgb, int texels)> profile;
    bool hdr = false;  ///< light above the screen's white is in it
    std::vector<std::string> notes;
};

/// Sets the curves of all three channels. `light` is that of a share of the greatest code, 0..1.
void set_curves(ScreenColour& colour, int levels, const std::function<double(double)>& light);

/// The linear value, 0..1, of each of `levels` codes. Precondition: not one of the decodings for textures only.
std::vector<float> screen_curve(Decode decode, int levels);

/// Codes as the decoding says, with the primaries of Rec. 709.
ScreenColour colour_of_decode(Decode decode, int levels);

/// Sets the matrix, and notes it. `what` is the subject of the note: "the file's chromaticities".
void set_primaries(ScreenColour& colour, const ColourPrimaries& primaries, const std::string& what);

/// The code points of ITU-T H.273: what PNG's cICP and the cicp of ICC profiles hold.
struct CodePoints {
    int primaries = 1, transfer = 13, matrix = 0;
    bool full_range = true;
};

/// PQ is light as shown, 203 cd/m² of it (the white of ITU-R BT.2408) being 1, at most 49.3. HLG is light of the scene,
/// and its white (a signal of 75 %) is 1, at most 3.77. Errors: code points that nothing is known of.
Result<ScreenColour> colour_of_code_points(const CodePoints& points, int levels);

/// The warnings of a picture: that it is not HDR, or what was assumed of it, and all notes.
std::vector<std::string> screen_warnings(const std::string& format, const ScreenColour& colour, bool assumed);

}  // namespace domelight
