#pragma once

#include "domelight/io/decode.h"

#include "cli/console/console.h"
#include "cli/console/display_options.h"

#include <optional>
#include <string>

namespace domelight::cli {

/// A picture that is converted as it is, pixel by pixel: a render, a layer of it, a photograph.
struct PictureConversion {
    std::string input, output;
    std::string layer;  ///< OpenEXR: which layer, channel or part; empty: the picture itself
    Decode decode = Decode::automatic;
    std::string encoding;  ///< .exr: half, float, or auto (also where empty): float where half would clip
    double exposure = 0;   ///< stops that radiance is multiplied by
    DisplayWords display;
};

/// Whether the file is a picture rather than an environment (picture_reader.h).
bool holds_a_picture(const std::string& file);
/// Whether the file can be converted as a picture at all: not a texture of a cube, a glTF file, a folder or a pipe.
bool may_be_a_picture(const std::string& file);

/// Errors: formats that hold no picture, an encoding that does not go with the format.
Result<void> check_picture_output(const PictureConversion& conversion);
/// Writes it; returns the exit code.
int convert_picture(const PictureConversion& conversion, const CommonOptions& common);

}  // namespace domelight::cli
