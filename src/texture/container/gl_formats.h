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

/// The layout of an OpenGL internal format of eight bits a channel, if it has a colour that can be read. `format`,
/// `type`: of the texels as they are stored (GL_RGBA, GL_BGRA, ... and GL_UNSIGNED_BYTE; both 0 for blocks).
std::optional<StatedScreenTexels> gl_format_screen_texels(std::uint32_t internal_format, std::uint32_t format,
                                                          std::uint32_t type);

}  // namespace domelight
