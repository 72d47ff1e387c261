#pragma once

#include "domelight/base/vec.h"

#include <optional>

namespace domelight {

/// CIE 1931 xy chromaticities of a set of red, green and blue lights and of the white that equal amounts of them make.
struct ColourPrimaries {
    struct Xy {
        double x = 0, y = 0;
    };
    Xy red{0.640, 0.330}, green{0.300, 0.600}, blue{0.150, 0.060}, white{0.3127, 0.3290};  ///< ITU-R BT.709 by default
};

/// RGB of these primaries to CIE XYZ with Y = 1 for white (SMPTE RP 177-1993, section 3.3). Empty if they lie on a
/// line.
std::optional<Mat3> rgb_to_xyz(const ColourPrimaries& primaries);

/// Whether the primaries are CIE XYZ itself: the axes, with equal energy as white, so that RGB are X, Y and Z.
bool are_xyz(const ColourPrimaries& primaries);

/// RGB of these primaries to linear Rec. 709. Where the whites differ, the light is adapted (Bradford), so that grey
/// stays grey. Not for CIE XYZ itself: equal energy is then not the file's grey, but follows from the axes; D65 becomes
/// grey, as by xyz_to_rec709().
std::optional<Mat3> rgb_to_rec709(const ColourPrimaries& primaries);

/// CIE XYZ to linear Rec. 709, not adapted: D65 becomes grey.
Mat3 xyz_to_rec709();

/// The same, adapted (Bradford) so that XYZ of this chromaticity become grey. Empty if it is no colour.
std::optional<Mat3> xyz_to_rec709(const ColourPrimaries::Xy& white);

/// Whether applying `m` would change no colour by more than rounding of the chromaticities does (2e-4).
bool is_nearly_identity(const Mat3& m);

}  // namespace domelight
