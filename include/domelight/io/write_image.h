#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace domelight {

/// Writers of images. Each output appears whole or not at all; an existing file is replaced only by a complete one.

/// Radiance HDR: RGBE, new run-length encoding (flat where the width does not allow it), mantissas rounded to the
/// nearest. The form with a RowSource writes row by row. Negative values and NaN become 0.
Result<void> write_hdr(const std::filesystem::path& file, ImageView<const float> rgb, int threads = 0);
Result<void> write_hdr(const std::filesystem::path& file, RowSource& rows, int threads = 0);

/// Whether half floats hold every value without clipping: none is beyond 65504 in either direction, nor infinite. This
/// is the rule by which the channels of an OpenEXR image are chosen where nobody asks for half or float.
bool fits_half(ImageView<const float> pixels);
/// The same for the remaining rows of a source, which are read in blocks up to the first block that does not fit.
Result<bool> fits_half(RowSource& rows);

struct ExrWriteOptions {
    /// Half or float channels. Empty: half if fits_half(pixels), else float. The overload with a RowSource then writes
    /// float, because it does not know the values in advance.
    std::optional<bool> half = {};
    std::string compression = "zip";  ///< none | rle | zips | zip | piz | pxr24 | b44 | b44a | dwaa | dwab
    /// The envmap attribute: "", "latlong" (the pixels must then be in OpenEXR's own lat-long convention) or "cube"
    /// (pixels: a size x 6 size strip of faces in OpenGL's orientation, which are turned into OpenEXR's).
    std::string envmap = {};
    std::map<std::string, std::string> attributes = {};  ///< further attributes of type string
    int threads = 0;                                     ///< for compression; 0: all
};
/// OpenEXR scanline image, RGB (or as many as 4 channels), linear Rec. 709. Where half is asked for, values beyond its
/// range are clipped to 65504.
Result<void> write_exr(const std::filesystem::path& file, ImageView<const float> pixels,
                       const ExrWriteOptions& options = {});
Result<void> write_exr(const std::filesystem::path& file, RowSource& rows, const ExrWriteOptions& options = {});

/// OpenEXR tiled image with levels (MIPMAP_LEVELS, sizes rounded down). `levels`: the finest first, each half as large
/// as the one before in both directions. The format requires levels down to 1 x 1; those that are missing are made from
/// the last one by averaging. With envmap "cube" each level is a strip of faces. Errors: no levels; a level that is not
/// half the size of the one before; a failure to write.
Result<void> write_exr_levels(const std::filesystem::path& file, std::span<const ImageView<const float>> levels,
                              const ExrWriteOptions& options = {});

/// One layer of an image with several layers.
struct ExrLayer {
    std::string name;  ///< the prefix of the channels' names: "direct" gives direct.R; empty for the picture itself
    ImageView<const float> pixels;  ///< 1 to 4 channels: Y (or `channel`), or R G B A
    std::string channel = {};       ///< the name of a single channel
};
/// OpenEXR scanline image of 32-bit floats with several layers of the same size. Of `options` only the attributes are
/// used.
Result<void> write_exr_layers(const std::filesystem::path& file, std::span<const ExrLayer> layers,
                              const ExrWriteOptions& options = {});

/// 8-bit PNG, 1, 3 or 4 channels, sRGB.
Result<void> write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels,
                       int compression_level = 3);

/// 8-bit JPEG (baseline, 4:4:4), 1 or 3 channels, sRGB. `quality`: 1 to 100, libjpeg's scale; the default leaves 8-bit
/// pictures without visible blocks. Errors: other numbers of channels; a side longer than 65500.
Result<void> write_jpeg(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels, int quality = 92);

/// The endings of pictures for a screen, which write_screen_picture() writes: ".png", ".jpg", ".jpeg".
std::span<const std::string> screen_picture_extensions();
/// Whether the file's name ends in one of them, in any case.
bool is_screen_picture(const std::filesystem::path& file);
/// Whether the format of this name can hold opacity: PNG can, JPEG cannot.
bool holds_opacity(const std::filesystem::path& file);
/// An 8-bit sRGB picture in the format that the file's name ends in: write_png() or write_jpeg().
/// Precondition: is_screen_picture(file).
Result<void> write_screen_picture(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels);

}  // namespace domelight
