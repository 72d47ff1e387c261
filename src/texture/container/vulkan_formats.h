#pragma once

#include "texture/container/texture_reading.h"

#include <cstdint>
#include <optional>
#include <string>

namespace domelight {

/// "VK_FORMAT_BC7_SRGB_BLOCK"; "VkFormat N" for numbers that no specification known here lists.
std::string vulkan_format_name(std::uint32_t format);

/// The encoding in which read_texture stores a Vulkan format, if it can.
std::optional<StoredTexels> vulkan_format_texels(std::uint32_t format);

/// The layout of a Vulkan format of eight bits a channel, if it has a colour that can be read.
std::optional<StatedScreenTexels> vulkan_format_screen_texels(std::uint32_t format);

}  // namespace domelight
