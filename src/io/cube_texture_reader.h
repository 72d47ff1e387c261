#pragma once

#include "domelight/environment.h"
#include "domelight/image.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace domelight {

/// "KTX2", "KTX" or "DDS" by a file's first bytes, else empty.
std::string texture_container(std::span<const std::uint8_t> bytes);

/// The finest level of a cube texture in one of our encodings, mended and times `scale`. The faces are taken to be
/// OpenGL's. Errors name the file.
Result<Cubemap> read_cube_texture(const std::filesystem::path& file, std::int64_t max_bytes, float scale,
                                  RepairReport& report);

}  // namespace domelight
