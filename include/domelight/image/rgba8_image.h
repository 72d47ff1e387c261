#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace domelight {

/// Texels as stored, 8 bits, RGBA, rows top to bottom.
struct Rgba8Image {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

}  // namespace domelight
