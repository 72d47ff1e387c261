#include "scene/gltf/gltf_chunks.h"
#include "scene/gltf/gltf_data.h"
#include "scene/gltf/gltf_meshes.h"
#include "scene/scene_images.h"
#include "scene/scene_readers.h"
#include "scene/sound_places.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace domelight {

namespace {

/// A frame without scale or shear that has the same orientation, for cameras and lights. Empty if the axes have
/// collapsed.
std::optional<Affine> rigid(const Affine& a) {
    const float depth = length(a.z);
    if (!is_sound(a) || !(depth > 0)) return std::nullopt;
    const Vec3f z = a.z / depth, side = cross(a.y, z);
    if (!(length(side) > 0)) return std::nullopt;
    const Vec3f x = normalize(side);
    return Affine{x, cross(z, x), z, a.translation};
}

/// Builds the scene from the document and its data.
class SceneBuilder {
  public:
    SceneBuilder(GltfDocument& document, GltfData& data, ByteBudget& budget, const SceneOptions& options)
        : document_(document), data_(data), budget_(budget), options_(options) {}
    Result<Scene> build();

  private:
    void find_places();
    Result<GltfPose> pose_of(const GltfSkin& skin);
    Result<std::vector<int>> meshes_of(const GltfNode& node);
    Result<std::vector<Affine>> places_of(const GltfNode& node, const Affine& place);
    bool fits_world(int mesh, const Affine& to_world);
    Result<void> add_instance(int mesh, const Affine& to_world, const std::string& name);
    Result<void> add_node(int index);
    Result<void> add_instances(const GltfNode& node, const Affine& place);
    Result<void> add_images();
    void add_warnings();
    int default_material();

    GltfDocument& document_;
    GltfData& data_;
    ByteBudget& budget_;
    const SceneOptions& options_;
    Scene scene_;
    std::vector<Affine> to_world_;                   // by node
    std::vector<int> order_;                         // nodes of the scene, parents first
    std::map<int, std::vector<int>> shared_meshes_;  // by mesh: those that are not changed by a skin or by the weights
                                                     // of a node
    MeshRepairs repairs_;
    GltfLeftOut left_out_;
    int default_material_ = -1;
    std::vector<Scene::Box> mesh_boxes_;                     // by mesh of the scene, as far as they were needed
    std::set<std::pair<int, std::array<float, 12>>> taken_;  // where a mesh stands already
    std::int64_t broken_places_ = 0, repeated_ = 0;
};

/// Where each node is; also of nodes outside the scene, which may be joints.
void SceneBuilder::find_places() {
    const std::vector<GltfNode>& nodes = document_.nodes;
    to_world_.resize(nodes.size());
    std::vector<int> waiting;
    const auto walk = [&](int root, std::vector<int>* order) {
        waiting.assign(1, root);
        while (!waiting.empty()) {
            const int n = waiting.back();
            waiting.pop_back();
            const GltfNode& node = nodes[std::size_t(n)];
            to_world_[std::size_t(n)] =
                node.parent < 0 ? node.to_parent : to_world_[std::size_t(node.parent)] * node.to_parent;
            if (order) order->push_back(n);
            waiting.insert(waiting.end(), node.children.rbegin(), node.children.rend());
        }
    };
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (nodes[n].parent < 0) walk(int(n), nullptr);
    for (const int root : document_.roots) walk(root, &order_);
}

/// A skin at rest: joint matrices times inverse bind matrices. The transform of the mesh's own node is ignored (glTF
/// 2.0, section 3.7.3.3).
Result<GltfPose> SceneBuilder::pose_of(const GltfSkin& skin) {
    std::vector<float> inverse;
    if (skin.inverse_bind >= 0) {
        if (data_.accessor(skin.inverse_bind).count < skin.joints.size())
            return Error{"fewer inverse bind matrices than joints", "", ""};
        if (const auto checked = data_.check(skin.inverse_bind, 16); !checked) return checked.error();
        inverse.resize(skin.joints.size() * 16);
        if (const auto done = data_.read(skin.inverse_bind, 0, skin.joints.size(), 16, inverse.data()); !done)
            return done.error();
    }
    GltfPose pose;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        Affine bind;
        if (const float* m = inverse.data() + 16 * j; !inverse.empty())
            bind = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
        pose.push_back(to_world_[std::size_t(skin.joints[j])] * bind);
    }
    return pose;
}

int SceneBuilder::default_material() {
    if (default_material_ < 0) {
        default_material_ = int(scene_.materials.size());
        scene_.materials.emplace_back().name = "default";
    }
    return default_material_;
}

/// The scene's meshes for a node: one for each primitive that has triangles.
Result<std::vector<int>> SceneBuilder::meshes_of(const GltfNode& node) {
    const GltfMesh& mesh = document_.meshes[std::size_t(node.mesh)];
    const bool shared = node.skin < 0 && node.weights.empty();
    if (shared)
        if (const auto built = shared_meshes_.find(node.mesh); built != shared_meshes_.end()) return built->second;
    GltfPose pose;
    if (node.skin >= 0) {
        auto found = pose_of(document_.skins[std::size_t(node.skin)]);
        if (!found) return Error{fmt::format("skins[{}]: {}", node.skin, found.error().what), "", ""};
        pose = std::move(*found);
    }
    std::vector<int> built;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const GltfPrimitive& primitive = mesh.primitives[p];
        const std::string name = mesh.name.empty() ? fmt::format("mesh {}", node.mesh) : mesh.name;
        auto triangles = build_gltf_mesh(data_, primitive, node.weights.empty() ? mesh.weights : node.weights, pose,
                                         name, budget_, repairs_, left_out_);
        if (!triangles)
            return Error{fmt::format("meshes[{}].primitives[{}]: {}", node.mesh, p, triangles.error().what), "",
                         triangles.error().hint};
        if (triangles->indices.empty()) continue;
        triangles->material = primitive.material >= 0 ? primitive.material : default_material();
        built.push_back(int(scene_.meshes.size()));
        scene_.meshes.push_back(std::move(*triangles));
    }
    if (shared) shared_meshes_[node.mesh] = built;
    return built;
}

/// The placements of a node's mesh: one, or those of EXT_mesh_gpu_instancing.
Result<std::vector<Affine>> SceneBuilder::places_of(const GltfNode& node, const Affine& place) {
    if (!node.instanced) return std::vector<Affine>{node.skin >= 0 ? Affine{} : place};
    std::uint64_t count = 0;
    std::vector<float> values[3];
    constexpr std::pair<const char*, int> k_parts[3] = {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}};
    for (int part = 0; part < 3; ++part) {
        const int accessor = gltf_attribute(node.instances, k_parts[part].first);
        if (accessor < 0) continue;
        const std::uint64_t n = data_.accessor(accessor).count;
        if (count && n != count) return Error{"instances: attributes of different lengths", "", ""};
        count = n;
        if (const auto checked = data_.check(accessor, k_parts[part].second); !checked) return checked.error();
        if (const auto room = budget_.take(count, 4 * 16, "instances"); !room) return room.error();
        values[part].resize(count * std::size_t(k_parts[part].second));
        if (const auto done = data_.read(accessor, 0, count, k_parts[part].second, values[part].data()); !done)
            return done.error();
    }
    std::vector<Affine> places;
    for (std::size_t i = 0; i < count; ++i) {
        const float *t = values[0].data() + 3 * i, *r = values[1].data() + 4 * i, *s = values[2].data() + 3 * i;
        places.push_back(place * affine_of_trs(values[0].empty() ? Vec3f{} : Vec3f{t[0], t[1], t[2]},
                                               values[1].empty() ? std::array<float, 4>{0, 0, 0, 1}
                                                                 : std::array<float, 4>{r[0], r[1], r[2], r[3]},
                                               values[2].empty() ? Vec3f{1, 1, 1} : Vec3f{s[0], s[1], s[2]}));
    }
    return places;
}

/// Whether a mesh that is put there stays within the coordinates that rays can be traced in.
bool SceneBuilder::fits_world(int mesh, const Affine& to_world) {
    if (!is_sound(to_world)) return false;
    for (std::size_t m = mesh_boxes_.size(); m < scene_.meshes.size(); ++m)
        mesh_boxes_.push_back(box_of(scene_.meshes[m], {}));
    const Scene::Box box = placed(mesh_boxes_[std::size_t(mesh)], to_world);
    return is_sound(box.low) && is_sound(box.high);
}

Result<void> SceneBuilder::add_instance(int mesh, const Affine& to_world, const std::string& name) {
    const auto& [x, y, z, t] = to_world;
    // Surfaces in exactly one place cannot be told apart, and a ray would have to meet all of them.
    if (!taken_.insert({mesh, {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, t.x, t.y, t.z}}).second) {
        ++repeated_;
        return {};
    }
    const Mesh& triangles = scene_.meshes[std::size_t(mesh)];
    // What the renderer makes of it: an entry, or triangles of its own where it cannot trace rays in the mesh's frame.
    constexpr std::size_t k_bytes_each = 1024, k_bytes_per_triangle = 160;
    const std::size_t copied = has_sound_inverse(to_world) ? 0 : std::size_t(triangles.triangle_count());
    if (const auto room =
            budget_.take(1, sizeof(Instance) + name.size() + k_bytes_each + copied * k_bytes_per_triangle, "instances");
        !room)
        return room.error();
    if (std::int64_t(scene_.instances.size()) >= options_.max_instances)
        return Error{fmt::format("meshes stand more than {} times in the scene", options_.max_instances), "",
                     "Put meshes that belong together into one."};
    scene_.instances.push_back({mesh, to_world, name.empty() ? triangles.name : name});
    return {};
}

Result<void> SceneBuilder::add_instances(const GltfNode& node, const Affine& place) {
    const auto meshes = meshes_of(node);
    if (!meshes) return meshes.error();
    const auto places = places_of(node, place);
    if (!places) return places.error();
    for (const Affine& to_world : *places)
        for (const int mesh : *meshes) {
            if (!fits_world(mesh, to_world))
                ++broken_places_;
            else if (const auto added = add_instance(mesh, to_world, node.name); !added)
                return added;
        }
    return {};
}

Result<void> SceneBuilder::add_node(int index) {
    const GltfNode& node = document_.nodes[std::size_t(index)];
    const Affine& place = to_world_[std::size_t(index)];
    if (node.mesh >= 0)
        if (const auto done = add_instances(node, place); !done) return done;
    if (node.camera < 0 && node.light < 0) return {};
    const std::optional<Affine> frame = rigid(place);
    if (!frame) {
        ++broken_places_;
        return {};
    }
    if (node.camera >= 0) {
        Camera camera = document_.cameras[std::size_t(node.camera)];
        camera.to_world = *frame;
        if (!node.name.empty()) camera.name = node.name;
        scene_.cameras.push_back(std::move(camera));
    }
    if (node.light >= 0) {
        PunctualLight light = document_.lights[std::size_t(node.light)];
        light.position = frame->translation;
        light.direction = -frame->z;
        if (!node.name.empty()) light.name = node.name;
        scene_.lights.push_back(std::move(light));
    }
    return {};
}

/// Decodes the images that materials use; other images are not even opened.
Result<void> SceneBuilder::add_images() {
    std::vector<SceneImageSource> sources;
    for (std::size_t i = 0; i < document_.images.size(); ++i) {
        const GltfImage& image = document_.images[i];
        std::string name = !image.name.empty()                           ? image.name
                           : is_data_uri(image.uri) || image.uri.empty() ? fmt::format("image {}", i)
                                                                         : image.uri;
        sources.push_back({std::move(name), [this, &image, i]() -> Result<std::shared_ptr<const FileBytes>> {
                               const auto named = [&](const Error& e) {
                                   return Error{fmt::format("images[{}]: {}", i, e.what), "", e.hint};
                               };
                               if (image.view < 0) {
                                   auto bytes = data_.resource(image.uri);
                                   return bytes ? bytes : named(bytes.error());
                               }
                               const auto bytes = data_.view(image.view);
                               if (!bytes) return named(bytes.error());
                               return FileBytes::from_memory({bytes->begin(), bytes->end()});
                           }});
    }
    return load_scene_images(sources, scene_, budget_, options_.threads);
}

void SceneBuilder::add_warnings() {
    scene_.warnings.insert(scene_.warnings.begin(), document_.warnings.begin(), document_.warnings.end());
    for (std::string& line : repairs_.warnings()) scene_.warnings.push_back(std::move(line));
    const auto say = [&](std::int64_t count, const char* what) {
        if (count) scene_.warnings.push_back(fmt::format("{} {}", count, what));
    };
    say(left_out_.points_and_lines, "primitives of points or lines left out: only triangles are drawn");
    say(left_out_.broken_joints, "weights of joints that the skin does not have left out");
    say(broken_places_, "nodes left out: their place is not finite, beyond 1e9 metres, or has no direction");
    say(repeated_, "instances left out: the same mesh stands in exactly the same place already");
}

Result<Scene> SceneBuilder::build() {
    scene_.materials = std::move(document_.materials);
    find_places();
    for (const int node : order_)
        if (const auto done = add_node(node); !done) return done.error();
    if (const auto done = add_images(); !done) return done.error();
    add_warnings();
    return std::move(scene_);
}

Result<Scene> build_scene(GltfDocument& document, const GltfChunks& chunks, const std::filesystem::path& folder,
                          const SceneOptions& options) {
    ByteBudget budget(options.max_bytes);
    auto data = GltfData::open(document, chunks.binary, folder, budget);
    if (!data) return data.error();
    return SceneBuilder(document, *data, budget, options).build();
}

}  // namespace

Result<Scene> read_gltf(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                        const SceneOptions& options) {
    const auto chunks = split_gltf(bytes->bytes());
    if (!chunks) return chunks.error();
    auto document = parse_gltf_document(chunks->json, options);
    if (!document) return document.error();
    return build_scene(*document, *chunks, folder, options);
}

Result<EnvironmentLights> read_gltf_lights(std::shared_ptr<const FileBytes> bytes, const std::filesystem::path& folder,
                                           const SceneOptions& options) {
    const auto chunks = split_gltf(bytes->bytes());
    if (!chunks) return chunks.error();
    auto document = parse_gltf_document(chunks->json, options);
    if (!document) return document.error();
    // Only lights are wanted: meshes, and the data that they are made of, are not read.
    for (GltfNode& node : document->nodes) node.mesh = -1;
    document->materials.clear();
    document->buffers.clear();
    auto scene = build_scene(*document, *chunks, folder, options);
    if (!scene) return scene.error();
    return EnvironmentLights{std::move(scene->lights), document->rotate_y_deg, std::move(scene->warnings)};
}

}  // namespace domelight
