#pragma once

#include "domelight/base/result.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace domelight {

/// The two chunks of a .glb (glTF 2.0, section 4.4), or a .gltf as its JSON alone.
struct GltfChunks {
    std::string_view json;
    std::span<const std::uint8_t> binary;
};

/// Errors: a .glb whose sizes do not fit together.
Result<GltfChunks> split_gltf(std::span<const std::uint8_t> bytes);

}  // namespace domelight
