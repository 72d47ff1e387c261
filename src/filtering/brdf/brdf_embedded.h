#pragma once

#include "domelight/image/image.h"

#include <cstdint>

namespace domelight {

/// The default BRDF table, computed when the library was built (cmake/brdf_table.cmake): the bits of size x size x 3
/// floats.
inline constexpr int k_brdf_embedded_size = 128;
extern const std::uint32_t k_brdf_embedded[k_brdf_embedded_size * k_brdf_embedded_size * 3];

/// The same as an image. The WebAssembly module computes it instead (wasm/brdf_embedded.cpp).
ImageF embedded_brdf_table();

}  // namespace domelight
