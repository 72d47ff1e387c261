#include "scene/gltf/gltf_vertices.h"

#include <fmt/format.h>

namespace domelight {

namespace {

class AccessorVertices : public GltfVertices {
  public:
    AccessorVertices(GltfData& data, const GltfPrimitive& primitive) : data_(data), primitive_(primitive) {}

    std::uint64_t count() const override {
        return data_.accessor(gltf_attribute(primitive_.attributes, "POSITION")).count;
    }
    int components(const std::string& semantic) const override {
        const int accessor = gltf_attribute(primitive_.attributes, semantic);
        return accessor < 0 ? 0 : data_.accessor(accessor).components;
    }
    Result<void> check(const std::string& semantic) override {
        const int accessor = gltf_attribute(primitive_.attributes, semantic);
        const std::uint64_t found = data_.accessor(accessor).count;
        if (found != count())
            return Error{fmt::format("{} has {} elements, but there are {} vertices", semantic, found, count()), "",
                         ""};
        return data_.check(accessor, components(semantic));
    }
    Result<void> read(const std::string& semantic, std::uint64_t first, std::uint64_t count, float* out) override {
        return data_.read(gltf_attribute(primitive_.attributes, semantic), first, count, components(semantic), out);
    }
    Result<std::vector<std::uint32_t>> indices() override {
        return primitive_.indices < 0 ? std::vector<std::uint32_t>{} : data_.read_indices(primitive_.indices);
    }

  private:
    GltfData& data_;
    const GltfPrimitive& primitive_;
};

}  // namespace

Result<std::unique_ptr<GltfVertices>> open_gltf_vertices(GltfData& data, const GltfPrimitive& primitive) {
    const int positions = gltf_attribute(primitive.attributes, "POSITION");
    if (positions < 0) return Error{"there are no positions", "", ""};
    if (const auto checked = data.check(positions, 3); !checked) return checked.error();
    return std::unique_ptr<GltfVertices>(std::make_unique<AccessorVertices>(data, primitive));
}

}  // namespace domelight
