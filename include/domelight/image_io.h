#pragma once

#include <filesystem>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>

#include "domelight/image.h"
#include "domelight/result.h"
#include "domelight/row_source.h"

namespace domelight {

/// Writers of images. Each output appears whole or not at all; an existing file is replaced only by a complete one.

/// Radiance HDR: RGBE, new run-length encoding (flat where the width does not allow it). The source form writes row by row.
Result<void> write_hdr(const std::filesystem::path& file, ImageView<const float> rgb);
Result<void> write_hdr(const std::filesystem::path& file, RowSource& rows);

struct ExrWriteOptions {
    bool half = true;                       ///< half or float channels
    std::string compression = "zip";        ///< none | rle | zips | zip | piz | pxr24 | b44 | b44a | dwaa | dwab
    std::string envmap;                     ///< "", "latlong" or "cube": the envmap attribute
    std::map<std::string, std::string> attributes;
};
/// OpenEXR scanline image, RGB (or as many as 4 channels), linear Rec. 709. A channel's values beyond half's range are clipped to 65504.
Result<void> write_exr(const std::filesystem::path& file, ImageView<const float> pixels, const ExrWriteOptions& options = {});
Result<void> write_exr(const std::filesystem::path& file, RowSource& rows, const ExrWriteOptions& options = {});

/// 8-bit PNG, 1, 3 or 4 channels, sRGB.
Result<void> write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels, int compression_level = 3);

/// A cube as one picture: "cross" (4 x 3 horizontal cross), "strip" (6 x 1).
ImageF cube_layout(const Cubemap& cube, const std::string& layout);

/// Writes a file by way of a temporary neighbour that replaces it once `write` has succeeded and all is on disk; removed otherwise (also on
/// SIGINT and SIGTERM). `write` gets the temporary path.
Result<void> write_file_atomically(const std::filesystem::path& file, const std::function<Result<void>(const std::filesystem::path&)>& write);
Result<void> write_file_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// For programs, once at the start: SIGINT, SIGTERM and SIGHUP then remove the temporary files of every write_file_atomically under way before
/// they end the program, and a file-size limit (SIGXFSZ) fails the write instead of killing it.
void remove_temporaries_on_signals();

}  // namespace domelight
