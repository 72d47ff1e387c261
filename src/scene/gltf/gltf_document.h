#pragma once
// The contents of the JSON of a glTF file, with every type and index checked. Numbers of bytes are not checked against
// the data here.

#include "domelight/scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace domelight {

struct GltfBuffer {
    std::string uri;  ///< empty: the binary chunk of a .glb, or a fallback buffer that holds nothing
    std::uint64_t length = 0;
};

/// EXT_meshopt_compression of a buffer view.
struct GltfMeshopt {
    int buffer = 0;
    std::uint64_t offset = 0, length = 0, stride = 0, count = 0;
    std::string mode, filter;
};

struct GltfView {
    int buffer = 0;
    std::uint64_t offset = 0, length = 0, stride = 0;  ///< stride 0: elements without gaps
    std::optional<GltfMeshopt> meshopt;
};

/// Numbers of this kind as glTF calls them.
enum GltfComponent : int {
    gltf_i8 = 5120,
    gltf_u8 = 5121,
    gltf_i16 = 5122,
    gltf_u16 = 5123,
    gltf_u32 = 5125,
    gltf_f32 = 5126
};

/// Bytes of a component; 0: no such kind.
inline std::size_t gltf_component_bytes(int component) {
    switch (component) {
        case gltf_i8:
        case gltf_u8:
            return 1;
        case gltf_i16:
        case gltf_u16:
            return 2;
        case gltf_u32:
        case gltf_f32:
            return 4;
        default:
            return 0;
    }
}

struct GltfAccessor {
    int view = -1;  ///< -1: zeros
    std::uint64_t offset = 0, count = 0;
    int component = gltf_f32;
    int components = 1;  ///< 1 to 4, or 16 for a MAT4
    bool normalized = false;
    struct Sparse {
        std::uint64_t count = 0;
        int index_view = 0, index_component = 0, value_view = 0;
        std::uint64_t index_offset = 0, value_offset = 0;
    };
    std::optional<Sparse> sparse;
};

/// Semantics and their accessors (or attributes of a Draco mesh), in alphabetical order.
using GltfAttributes = std::vector<std::pair<std::string, int>>;

/// The number that goes with a semantic; -1: none.
int gltf_attribute(const GltfAttributes& attributes, std::string_view semantic);

struct GltfPrimitive {
    GltfAttributes attributes;
    std::vector<GltfAttributes> targets;
    int indices = -1, material = -1, mode = 4;
    int draco_view = -1;  ///< KHR_draco_mesh_compression; -1: none
    GltfAttributes draco_attributes;
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
    std::vector<float> weights;
};

struct GltfNode {
    std::string name;
    int mesh = -1, skin = -1, camera = -1, light = -1, parent = -1;
    std::vector<int> children;
    Affine to_parent;
    std::vector<float> weights;
    bool instanced = false;  ///< EXT_mesh_gpu_instancing
    GltfAttributes instances;
};

struct GltfSkin {
    int inverse_bind = -1;  ///< accessor; -1: identities
    std::vector<int> joints;
};

struct GltfImage {
    std::string name, uri, mime_type;
    int view = -1;
};

struct GltfDocument {
    std::vector<GltfBuffer> buffers;
    std::vector<GltfView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<GltfMesh> meshes;
    std::vector<GltfNode> nodes;  ///< a forest: parents are set, and no node is its own ancestor
    std::vector<GltfSkin> skins;
    std::vector<GltfImage> images;
    std::vector<Material> materials;  ///< their textures name `images`
    std::vector<Camera> cameras;      ///< without a place
    std::vector<PunctualLight> lights;
    float rotate_y_deg = 0;  ///< asset.extras: how far the environment was turned whose lights these are
    std::vector<int> roots;  ///< of the scene to show
    std::vector<std::string> warnings;
};

/// Reads the JSON. Errors: not JSON, not glTF 2.0, members of a wrong type, indices out of range, nodes that do not
/// form a forest, an extension that is required and unknown. They name no file.
Result<GltfDocument> parse_gltf_document(std::string_view json, const SceneOptions& options);

/// Translation, rotation (a quaternion x, y, z, w of any length; none of it: no rotation) and scale: scale first.
Affine affine_of_trs(const Vec3f& translation, const std::array<float, 4>& rotation, const Vec3f& scale);

}  // namespace domelight
