#pragma once

#include "io/file/byte_budget.h"
#include "scene/gltf/gltf_document.h"

#include <span>
#include <vector>

namespace domelight {

/// Unpacks a buffer view of EXT_meshopt_compression: count x stride bytes. Errors: parameters that the extension does
/// not allow, broken data.
Result<std::vector<std::uint8_t>> unpack_meshopt(const GltfMeshopt& about, std::span<const std::uint8_t> packed,
                                                 ByteBudget& budget);

}  // namespace domelight
