#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/io/decode.h"

#include <filesystem>
#include <string>
#include <vector>

namespace domelight {

/// A picture to be compared: all values are kept, NaN too; nothing is repaired.
struct Picture {
    std::string format;  ///< "OpenEXR", "PNG", "KTX2", ...
    std::string layer;   ///< OpenEXR: the layer that was read; empty: the unnamed one
    ImageF rgb;          ///< linear Rec. 709 radiance; a cube: its faces +X -X +Y -Y +Z -Z one below the other
    bool high_dynamic_range = true;  ///< false: 8 or 16 bits for a screen, decoded from sRGB to [0, 1]
    bool cube = false;
    ImageF variance;  ///< of the pixels' values, 3 channels; empty: unknown. From the layer "variance" (or Variance),
                      ///< see below
    ImageF objects;   ///< index of the object, one channel, 0 for the background; empty: not known. From the layer or
                      ///< channel "object"
    std::vector<std::string>
        object_names;  ///< of the objects from 1 on, by the attribute "objects", one a line; may be short
    /// One channel, the OpenEXR channel A or a PNG's alpha; empty: none, or not asked for (PictureOptions::opacity).
    /// If cut_out(), `rgb` is premultiplied by it.
    ImageF opacity;
    std::vector<std::string> warnings;

    /// Whether the picture has a transparent background: its colour is black wherever the opacity is 0. Renderers also
    /// store an opacity in pictures that show a background; for these it is false. False without an opacity.
    bool cut_out() const;
};

struct PictureOptions {
    std::string layer = {};  ///< OpenEXR: which layer, channel or part, as in EnvironmentOptions
    int level = 0;           ///< textures: which level
    /// The meaning of a file's layer "variance": the variance of the pixel's value, or that of one sample, to be
    /// divided by the channel "samples".
    std::string variance = "pixel";     ///< pixel | sample
    bool opacity = false;               ///< read it where there is one
    Decode decode = Decode::automatic;  ///< PNG and JPEG
    std::int64_t max_bytes = std::int64_t(1) << 30;
    int threads = 0;
};

/// What a file says of the picture in it.
struct PictureFacts {
    std::string format;  ///< "OpenEXR", "PNG", "KTX2", ...
    int width = 0, height = 0;
    std::vector<std::string> layers;    ///< OpenEXR: "" for the unnamed one, "direct", ...
    std::vector<std::string> channels;  ///< OpenEXR: all that are not deep
    bool environment = false;           ///< OpenEXR's attribute envmap is set
    bool cube = false;                  ///< a texture with six faces
};
/// Reads the file's header, not its pixels. Errors: as read_picture.
Result<PictureFacts> read_picture_facts(const std::filesystem::path& file);
/// Whether the file holds a picture rather than an environment: its shape is no environment's (open_environment.h), it
/// has several layers, as renderers write them, or it is 4:3 or 3:4 and one of the areas that a cross of cube faces
/// leaves empty is not of one colour. False where the file cannot be read.
bool is_picture_of_its_own(const std::filesystem::path& file);

/// Reads OpenEXR, Radiance HDR, PNG, JPEG, or a level of a KTX2, KTX or DDS texture (2D or cube). Errors name the file.
Result<Picture> read_picture(const std::filesystem::path& file, const PictureOptions& options = {});

/// One channel of numbers. Of an OpenEXR file the channel `name` (empty: the first that exists of object, Y, R and A,
/// otherwise the file's first one); of a PNG or JPEG the red channel times 255, rounded; of a Radiance HDR the red
/// channel. Errors name the file.
Result<ImageF> read_number_image(const std::filesystem::path& file, const std::string& name = "");

}  // namespace domelight
