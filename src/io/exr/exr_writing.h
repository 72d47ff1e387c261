#pragma once
// Functions shared by the writers of OpenEXR images. All of them may throw OpenEXR's exceptions.

#include "domelight/io/write_image.h"

#include "io/exr/exr_output_stream.h"

#include <ImfHeader.h>

#include <functional>
#include <vector>

namespace domelight {

/// Names of 1 to 4 interleaved channels: Y, or R G B A.
std::vector<const char*> exr_channel_names(int channels);

/// A header of the options' compression, envmap and attributes, with half or float channels. Errors: an unknown
/// compression or envmap, a cube that is not a strip, an attribute whose name belongs to another type.
Result<Imf::Header> exr_header(int width, int height, int channels, bool half, const ExrWriteOptions& options);

/// Writes a file through a stream; an exception from `write` becomes an error.
Result<void> write_exr_file(const std::filesystem::path& file,
                            const std::function<Result<void>(ExrOutputStream& stream)>& write);

}  // namespace domelight
