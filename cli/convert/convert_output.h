#pragma once

#include "domelight/base/result.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/texture/texture.h"

#include "preview/tonemap.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace domelight::cli {

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
/// `where` is the option. Sets the layout and the encoding that were left out.
Result<void> check_output(ConvertOutput& output, const Projection& projection);

struct WrittenPicture {
    std::vector<std::string> files;
    std::string encoding_name;
    bool widened = false;     ///< `encoding_name` is float, because half would clip
    EncodingReport encoding;  ///< what the encoding clipped; textures and half .exr
};

/// Writes the picture, in one file or one a chart (`name_px.hdr`, `name_front.hdr`). All of them appear whole, or none.
Result<WrittenPicture> write_projected(const ProjectedImage& image, const ConvertOutput& output);

}  // namespace domelight::cli
