#pragma once

#include "scene/gltf/gltf_data.h"

#include <memory>
#include <string>
#include <vector>

namespace domelight {

/// The vertices and indices of one primitive, wherever they are stored.
class GltfVertices {
  public:
    virtual ~GltfVertices() = default;
    virtual std::uint64_t count() const = 0;
    /// Components of an attribute; 0: there is none of that name.
    virtual int components(const std::string& semantic) const = 0;
    /// Checks that an attribute is complete and as long as the positions, before memory is allocated for it.
    virtual Result<void> check(const std::string& semantic) = 0;
    /// Values of vertices [first, first + count), count x components of them. Precondition: checked.
    virtual Result<void> read(const std::string& semantic, std::uint64_t first, std::uint64_t count, float* out) = 0;
    /// Empty: vertices in the order they are in.
    virtual Result<std::vector<std::uint32_t>> indices() = 0;
};

/// From accessors. Errors: no positions, or they are not all there.
Result<std::unique_ptr<GltfVertices>> open_gltf_vertices(GltfData& data, const GltfPrimitive& primitive);

/// From KHR_draco_mesh_compression. Errors: broken data.
Result<std::unique_ptr<GltfVertices>> open_draco_vertices(GltfData& data, const GltfPrimitive& primitive,
                                                          ByteBudget& budget);

}  // namespace domelight
