#pragma once
// A converted environment as files of any format.

#include "domelight/base/result.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/texture/texture.h"

#include "preview/tonemap.h"

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace domelight {

/// How a picture of several charts goes into files.
struct ConvertOutput {
    std::string file;
    std::string layout;    ///< empty: the format's and projection's own
    std::string encoding;  ///< empty: auto for .exr (half, or float where half would clip), rgba16f for textures
    Display display;       ///< of .png and .jpg
    int threads = 0;
    std::vector<std::filesystem::path> inputs;  ///< not to be replaced by a name that is made of `file`
};

/// Errors: a format that is not known, a layout or an encoding that does not go with it or with the projection;
/// `where` is the field. Sets the layout and the encoding that were left out.
Result<void> check_converted_files(ConvertOutput& output, const Projection& projection);

/// The endings of files that a conversion writes: ".hdr", ".exr", ...
std::span<const std::string> converted_file_extensions();
/// Whether a file's name ends as that of a texture does (.ktx2, .ktx, .dds), in any case.
bool has_texture_ending(const std::string& file);

/// Width and height of a chart of `height` texels. Errors: more than 4 GiB; `where` is the field `size`.
Result<std::pair<int, int>> chart_size(const Projection& target, int height);

/// How a light is turned: axis and degrees, clockwise as seen from the axis's tip, one turn after the other.
/// mirror   afterwards: x, y or z; empty: not at all
/// Errors: an axis without length or not finite; another name for `mirror`.
Result<Mat3> light_turn(std::span<const std::array<double, 4>> rotations, const std::string& mirror);

/// The display of a converted picture by its automatic exposure: each texel counts by its solid angle.
double automatic_ev_of_sphere(const ProjectedImage& image);

struct WrittenPicture {
    std::vector<std::string> files;
    std::string encoding_name;
    bool widened = false;     ///< `encoding_name` is float, because half would clip
    EncodingReport encoding;  ///< what the encoding clipped; textures and half .exr
};

/// Writes the picture, in one file or one a chart (`name_px.hdr`, `name_front.hdr`). All of them appear whole, or none.
Result<WrittenPicture> write_projected(const ProjectedImage& image, const ConvertOutput& output);

}  // namespace domelight
