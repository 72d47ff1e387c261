#include "scene/gltf/gltf_vertices.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace domelight {

namespace {

const Error k_broken{"broken Draco data", "", "The file is truncated or damaged."};

/// Draco's variable-length integers: seven bits a byte, the lowest first.
bool varint(std::span<const std::uint8_t> bytes, std::size_t& at, std::uint64_t& value) {
    value = 0;
    for (int shift = 0; shift < 35 && at < bytes.size(); shift += 7) {
        value |= std::uint64_t(bytes[at] & 0x7f) << shift;
        if (!(bytes[at++] & 0x80)) return true;
    }
    return false;
}

/// How many faces and vertices the bitstream claims (Draco bitstream specification, headers of version 2.2, which glTF
/// demands). The decoder allocates by them before it looks further.
bool claimed_counts(std::span<const std::uint8_t> bytes, std::uint64_t& faces, std::uint64_t& vertices) {
    if (bytes.size() < 12 || std::memcmp(bytes.data(), "DRACO", 5) != 0 || bytes[5] != 2 || bytes[6] != 2) return false;
    const bool mesh = bytes[7] == 1, edgebreaker = bytes[8] == 1, metadata = bytes[10] & 0x80;
    if (!mesh || metadata) return false;
    std::size_t at = 11;
    if (edgebreaker)
        return ++at, varint(bytes, at, vertices) && varint(bytes, at, faces);  // first the kind of traversal
    return varint(bytes, at, faces) && varint(bytes, at, vertices);
}

class DracoVertices : public GltfVertices {
  public:
    DracoVertices(GltfData& data, const GltfPrimitive& primitive, std::unique_ptr<draco::Mesh> mesh)
        : data_(data), primitive_(primitive), mesh_(std::move(mesh)) {}

    std::uint64_t count() const override { return mesh_->num_points(); }
    int components(const std::string& semantic) const override {
        const draco::PointAttribute* attribute = find(semantic);
        return attribute ? attribute->num_components() : 0;
    }
    Result<void> check(const std::string& semantic) override {
        const draco::PointAttribute* attribute = find(semantic);
        return attribute && attribute->num_components() <= 4 ? Result<void>() : k_broken;
    }
    Result<void> read(const std::string& semantic, std::uint64_t first, std::uint64_t count, float* out) override;
    Result<std::vector<std::uint32_t>> indices() override;

  private:
    const draco::PointAttribute* find(const std::string& semantic) const {
        const int id = gltf_attribute(primitive_.draco_attributes, semantic);
        return id < 0 ? nullptr : mesh_->GetAttributeByUniqueId(std::uint32_t(id));
    }

    GltfData& data_;
    const GltfPrimitive& primitive_;
    std::unique_ptr<draco::Mesh> mesh_;
};

Result<void> DracoVertices::read(const std::string& semantic, std::uint64_t first, std::uint64_t count, float* out) {
    const draco::PointAttribute& attribute = *find(semantic);
    const int components = attribute.num_components();
    // Integers are not normalised unless Draco marks them as normalised; the accessor decides.
    float scale = 1;
    const int accessor = gltf_attribute(primitive_.attributes, semantic);
    if (accessor >= 0 && data_.accessor(accessor).normalized && !attribute.normalized()) {
        const draco::DataType type = attribute.data_type();
        scale = type == draco::DT_UINT8    ? 1.0f / 255
                : type == draco::DT_INT8   ? 1.0f / 127
                : type == draco::DT_UINT16 ? 1.0f / 65535
                : type == draco::DT_INT16  ? 1.0f / 32767
                                           : 1.0f;
    }
    for (std::uint64_t i = 0; i < count; ++i, out += components) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(std::uint32_t(first + i)));
        if (value.value() >= attribute.size() || !attribute.ConvertValue<float>(value, std::int8_t(components), out))
            return k_broken;
        if (scale != 1)
            for (int c = 0; c < components; ++c) out[c] = std::max(out[c] * scale, -1.0f);
    }
    return {};
}

Result<std::vector<std::uint32_t>> DracoVertices::indices() {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t(mesh_->num_faces()) * 3);
    for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
        for (const draco::PointIndex& point : mesh_->face(f)) indices.push_back(point.value());
    return indices;
}

}  // namespace

Result<std::unique_ptr<GltfVertices>> open_draco_vertices(GltfData& data, const GltfPrimitive& primitive,
                                                          ByteBudget& budget) {
    const auto packed = data.view(primitive.draco_view);
    if (!packed) return packed.error();
    std::uint64_t faces = 0, vertices = 0;
    if (!claimed_counts(*packed, faces, vertices)) return Error{"the data is not a Draco mesh of version 2.2", "", ""};
    // No real file compresses a thousand faces into a byte, and a face adds at most three vertices.
    if (faces > 1024 * std::uint64_t(packed->size()) || vertices > 3 * faces)
        return Error{
            fmt::format("Draco: {} bytes cannot hold {} faces and {} vertices", packed->size(), faces, vertices), "",
            ""};
    constexpr std::uint64_t bytes_a_face = 200;  // corner tables, and attributes while they are decoded
    if (const auto room = budget.take(faces, bytes_a_face, "Draco"); !room) return room.error();
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(packed->data()), packed->size());
        draco::Decoder decoder;
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        if (!mesh.ok())
            return Error{fmt::format("broken Draco data: {}", mesh.status().error_msg_string()), "", k_broken.hint};
        auto vertices_of = std::make_unique<DracoVertices>(data, primitive, std::move(mesh).value());
        if (vertices_of->components("POSITION") != 3) return Error{"there are no positions", "", ""};
        return std::unique_ptr<GltfVertices>(std::move(vertices_of));
    } catch (const std::exception&) {
        return k_broken;
    }
}

}  // namespace domelight
