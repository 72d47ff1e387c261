#include "scene/gltf/gltf_meshes.h"

#include "scene/gltf/gltf_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace domelight {

namespace {

/// Three indices a triangle, from a list, strip or fan (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> in, int mode) {
    if (mode == 4) {
        in.resize(in.size() / 3 * 3);
        return in;
    }
    std::vector<std::uint32_t> out;
    if (in.size() < 3) return out;
    out.reserve((in.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < in.size(); ++i) {
        const std::size_t odd = i % 2;
        if (mode == 5)
            out.insert(out.end(), {in[i], in[i + 1 + odd], in[i + 2 - odd]});
        else
            out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
    }
    return out;
}

/// Builds one mesh from the vertices that its indices reach.
class MeshBuilder {
  public:
    MeshBuilder(GltfData& data, const GltfPrimitive& primitive, GltfVertices& vertices, ByteBudget& budget)
        : data_(data), primitive_(primitive), vertices_(vertices), budget_(budget) {}

    Result<void> read_indices();
    Result<void> read_attributes();
    Result<void> add_targets(const std::vector<float>& weights);
    Result<void> skin(const GltfPose& pose, GltfLeftOut& left_out);
    Mesh mesh;

  private:
    /// An attribute of vertices first_ .. first_ + count_ - 1; empty: there is none. A wrong number of components is an
    /// error.
    Result<std::vector<float>> read(const std::string& semantic, int least, int most);
    template <typename T>
    Result<void> read_into(const std::string& semantic, std::vector<T>& out);
    Result<void> add_target(const GltfAttributes& target, const char* semantic, float weight, float* values,
                            std::size_t step);

    GltfData& data_;
    const GltfPrimitive& primitive_;
    GltfVertices& vertices_;
    ByteBudget& budget_;
    std::uint64_t first_ = 0, count_ = 0;
};

Result<void> MeshBuilder::read_indices() {
    auto indices = vertices_.indices();
    if (!indices) return indices.error();
    if (indices->empty() && primitive_.indices < 0 && primitive_.draco_view < 0) {
        if (vertices_.count() > std::uint64_t(std::numeric_limits<std::int32_t>::max()))
            return Error{"more than 2^31 vertices", "", ""};
        if (const auto room = budget_.take(vertices_.count(), 4, "indices"); !room) return room.error();
        indices->resize(vertices_.count());
        std::iota(indices->begin(), indices->end(), 0u);
    }
    if (primitive_.mode != 4 && primitive_.draco_view < 0)
        if (const auto room = budget_.take(indices->size(), 12, "strips"); !room) return room.error();
    // Draco's faces are triangles whatever the mode was.
    mesh.indices = as_triangles(std::move(*indices), primitive_.draco_view < 0 ? primitive_.mode : 4);
    if (mesh.indices.empty()) return {};
    const auto [low, high] = std::minmax_element(mesh.indices.begin(), mesh.indices.end());
    if (*high >= vertices_.count())
        return Error{fmt::format("index {}, but there are {} vertices", *high, vertices_.count()), "", ""};
    // Primitives often share one large array: each keeps only its part.
    first_ = *low, count_ = std::uint64_t(*high) - first_ + 1;
    if (first_)
        for (std::uint32_t& index : mesh.indices) index -= std::uint32_t(first_);
    return {};
}

template <typename T>
Result<void> MeshBuilder::read_into(const std::string& semantic, std::vector<T>& out) {
    static_assert(sizeof(T) % sizeof(float) == 0);
    const int found = vertices_.components(semantic), wanted = int(sizeof(T) / sizeof(float));
    if (!found) return {};
    if (found != wanted)
        return Error{fmt::format("{} has {} components instead of {}", semantic, found, wanted), "", ""};
    if (const auto checked = vertices_.check(semantic); !checked) return checked.error();
    if (const auto room = budget_.take(count_, sizeof(T), semantic); !room) return room.error();
    out.resize(count_);
    return vertices_.read(semantic, first_, count_, reinterpret_cast<float*>(out.data()));
}

Result<std::vector<float>> MeshBuilder::read(const std::string& semantic, int least, int most) {
    const int found = vertices_.components(semantic);
    if (!found) return std::vector<float>{};
    if (found < least || found > most) return Error{fmt::format("{} has {} components", semantic, found), "", ""};
    if (const auto checked = vertices_.check(semantic); !checked) return checked.error();
    if (const auto room = budget_.take(count_, sizeof(float) * std::size_t(found), semantic); !room)
        return room.error();
    std::vector<float> values(count_ * std::size_t(found));
    if (const auto done = vertices_.read(semantic, first_, count_, values.data()); !done) return done.error();
    return values;
}

Result<void> MeshBuilder::read_attributes() {
    if (const auto done = read_into("POSITION", mesh.positions); !done) return done;
    if (const auto done = read_into("NORMAL", mesh.normals); !done) return done;
    // Without normals the surface is flat, and tangents are to be ignored.
    if (!mesh.normals.empty())
        if (const auto done = read_into("TANGENT", mesh.tangents); !done) return done;
    if (const auto done = read_into("TEXCOORD_0", mesh.texcoords[0]); !done) return done;
    if (const auto done = read_into("TEXCOORD_1", mesh.texcoords[1]); !done) return done;
    const auto colors = read("COLOR_0", 3, 4);
    if (!colors) return colors.error();
    if (colors->empty()) return {};
    const std::size_t step = colors->size() / count_;
    if (const auto room = budget_.take(count_, sizeof(Mesh::Color), "COLOR_0"); !room) return room;
    mesh.colors.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
        const float* c = colors->data() + i * step;
        mesh.colors[i] = {{c[0], c[1], c[2]}, step == 4 ? c[3] : 1.0f};
    }
    return {};
}

/// values[i] += weight * displacement[i] for the three components at every `step` floats.
Result<void> MeshBuilder::add_target(const GltfAttributes& target, const char* semantic, float weight, float* values,
                                     std::size_t step) {
    const int accessor = gltf_attribute(target, semantic);
    if (accessor < 0) return {};
    if (data_.accessor(accessor).count < first_ + count_)
        return Error{fmt::format("a morph target's {} is too short", semantic), "", ""};
    if (const auto checked = data_.check(accessor, 3); !checked) return checked;
    std::vector<float> displacement(count_ * 3);
    if (const auto done = data_.read(accessor, first_, count_, 3, displacement.data()); !done) return done;
    for (std::size_t i = 0; i < count_; ++i)
        for (std::size_t c = 0; c < 3; ++c) values[i * step + c] += weight * displacement[i * 3 + c];
    return {};
}

Result<void> MeshBuilder::add_targets(const std::vector<float>& weights) {
    for (std::size_t t = 0; t < std::min(weights.size(), primitive_.targets.size()); ++t) {
        const float weight = weights[t];
        const GltfAttributes& target = primitive_.targets[t];
        if (weight == 0) continue;
        if (const auto done = add_target(target, "POSITION", weight, &mesh.positions[0].x, 3); !done) return done;
        if (!mesh.normals.empty())
            if (const auto done = add_target(target, "NORMAL", weight, &mesh.normals[0].x, 3); !done) return done;
        if (!mesh.tangents.empty())
            if (const auto done = add_target(target, "TANGENT", weight, &mesh.tangents[0].t.x, 4); !done) return done;
    }
    return {};
}

Affine scaled(const Affine& a, float s) {
    return {a.x * s, a.y * s, a.z * s, a.translation * s};
}
Affine sum(const Affine& a, const Affine& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.translation + b.translation};
}

/// Linear blend skinning (glTF 2.0, section 3.7.3.3): each vertex by the weighted mean of its joints' matrices.
Result<void> MeshBuilder::skin(const GltfPose& pose, GltfLeftOut& left_out) {
    std::vector<Affine> blend;
    std::vector<float> total;
    for (int set = 0; set < 4; ++set) {
        const auto joints = read(fmt::format("JOINTS_{}", set), 4, 4);
        if (!joints) return joints.error();
        const auto weights = read(fmt::format("WEIGHTS_{}", set), 4, 4);
        if (!weights) return weights.error();
        if (joints->empty() || weights->empty()) break;
        if (blend.empty()) {
            if (const auto room = budget_.take(count_, sizeof(Affine) + 4, "skinning"); !room) return room;
            blend.resize(count_, Affine{{}, {}, {}, {}});
            total.resize(count_);
        }
        for (std::size_t i = 0; i < count_ * 4; ++i) {
            const float weight = (*weights)[i], joint = (*joints)[i];
            if (!(weight > 0) || !std::isfinite(weight)) continue;
            if (!(joint >= 0 && joint < float(pose.size()))) {
                ++left_out.broken_joints;
                continue;
            }
            blend[i / 4] = sum(blend[i / 4], scaled(pose[std::size_t(joint)], weight));
            total[i / 4] += weight;
        }
    }
    for (std::size_t i = 0; i < blend.size(); ++i) {
        // Weights are normalised to sum to one; a vertex without joints is not moved.
        if (!(total[i] > 0)) continue;
        const Affine m = scaled(blend[i], 1 / total[i]);
        mesh.positions[i] = m.point(mesh.positions[i]);
        if (!mesh.normals.empty())
            mesh.normals[i] = m.determinant() < 0 ? -m.normal(mesh.normals[i]) : m.normal(mesh.normals[i]);
        if (!mesh.tangents.empty()) mesh.tangents[i].t = m.vector(mesh.tangents[i].t);
    }
    return {};
}

}  // namespace

Result<Mesh> build_gltf_mesh(GltfData& data, const GltfPrimitive& primitive, const std::vector<float>& weights,
                             const GltfPose& pose, const std::string& name, ByteBudget& budget, MeshRepairs& repairs,
                             GltfLeftOut& left_out) {
    if (primitive.mode < 4) {
        ++left_out.points_and_lines;
        return Mesh{};
    }
    auto vertices =
        primitive.draco_view >= 0 ? open_draco_vertices(data, primitive, budget) : open_gltf_vertices(data, primitive);
    if (!vertices) return vertices.error();
    MeshBuilder builder(data, primitive, **vertices, budget);
    builder.mesh.name = name;
    if (const auto done = builder.read_indices(); !done) return done.error();
    if (builder.mesh.indices.empty()) return Mesh{};
    if (const auto done = builder.read_attributes(); !done) return done.error();
    if (const auto done = builder.add_targets(weights); !done) return done.error();
    if (!pose.empty())
        if (const auto done = builder.skin(pose, left_out); !done) return done.error();
    repairs.mend(builder.mesh);
    return std::move(builder.mesh);
}

}  // namespace domelight
