#pragma once

#include "texture/container/screen_texels.h"
#include "texture/container/texture_reading.h"

#include <cstdint>
#include <optional>
#include <string>

namespace domelight {

/// A texel format of a DDS file.
struct DdsFormat {
    std::string name;    ///< "DXGI_FORMAT_R16G16B16A16_FLOAT", "DXT5", "BGRA8"
    int block = 1;       ///< texels along a side of a block
    int block_bits = 0;  ///< 0: unknown, so that the file's size cannot be checked
    std::optional<StoredTexels> texels;
    std::optional<ScreenTexels> screen = std::nullopt;  ///< eight bits a channel; `texels` is then empty
};

/// A format by its DXGI_FORMAT number (DX10 header).
DdsFormat dxgi_format(std::uint32_t number);

/// The DXGI_FORMAT of an encoding.
std::uint32_t dxgi_number(Encoding encoding);  ///< 0: it has none

/// The D3DFORMAT number of an encoding in the older header; 0: none.
std::uint32_t d3d_number(Encoding encoding);

/// A format of the older header: four characters or a D3DFORMAT number, or channel masks.
DdsFormat legacy_dds_format(std::uint32_t flags, std::uint32_t four_cc, std::uint32_t bits,
                            const std::uint32_t (&masks)[4]);

}  // namespace domelight
