#pragma once

#include "texture/container/texture_reading.h"

#include <cstdint>
#include <optional>
#include <string>

namespace domelight {

/// "GL_R11F_G11F_B10F"; "GL internal format 0x...." for numbers not known here.
std::string gl_format_name(std::uint32_t internal_format);

/// The encoding in which read_texture stores an OpenGL internal format with texels of `type`, if it can.
std::optional<StoredTexels> gl_format_texels(std::uint32_t internal_format, std::uint32_t type);

}  // namespace domelight
