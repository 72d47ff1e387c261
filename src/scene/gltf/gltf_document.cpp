#include "scene/gltf/gltf_document.h"

#include "io/file/json.h"
#include "io/file/json_fields.h"
#include "io/file/printable.h"
#include "io/image_reader.h"
#include "scene/gltf/gltf_materials.h"
#include "scene/sound_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

constexpr const char* k_known_extensions[] = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",  "EXT_texture_webp",        "KHR_draco_mesh_compression",
    "KHR_lights_punctual",     "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_sheen",      "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",     "KHR_materials_volume",     "KHR_mesh_quantization",   "KHR_texture_transform"};

constexpr float k_largest_aspect = 1e6f;  // of a camera's picture, width / height

/// Read by itself, as an environment (gltf_image_light.h).
constexpr const char* k_image_light = "EXT_lights_image_based";

bool known_extension(const std::string& name) {
    return std::find(std::begin(k_known_extensions), std::end(k_known_extensions), name) !=
           std::end(k_known_extensions);
}

int components_of(const std::string& type) {
    constexpr std::pair<const char*, int> k_types[] = {{"SCALAR", 1}, {"VEC2", 2},  {"VEC3", 3}, {"VEC4", 4},
                                                       {"MAT2", -1},  {"MAT3", -1}, {"MAT4", 16}};
    for (const auto& [name, components] : k_types)
        if (type == name) return components;
    return 0;
}

/// Reads the document part by part. Faults of members are kept in `error_`.
class DocumentParser {
  public:
    DocumentParser(const Json& json, const SceneOptions& options) : root_(json, "", error_), options_(options) {}
    Result<GltfDocument> parse();

  private:
    void read_asset();
    void read_buffers();
    GltfView read_view(JsonFields& fields);
    GltfAccessor read_accessor(JsonFields& fields);
    GltfPrimitive read_primitive(JsonFields& fields, std::size_t materials);
    void read_meshes();
    GltfNode read_node(JsonFields& fields, std::size_t nodes, std::size_t lights);
    void read_skins(std::size_t nodes);
    void read_orthographic(JsonFields& fields, Camera& camera);
    void read_cameras();
    void read_lights();
    void read_images_and_materials();
    void read_roots();
    void set_parents();

    std::optional<Error> error_;
    JsonFields root_;
    const SceneOptions& options_;
    GltfDocument document_;
};

void DocumentParser::read_asset() {
    const std::string version = root_.require("asset").object("asset").require("version").text("version");
    if (version.substr(0, 2) != "2.")
        root_.fail("asset.version", fmt::format("is \"{}\", but only glTF 2.0 is read", printable(version, 20)));
    for (const std::string& name : root_.texts("extensionsRequired"))
        if (!known_extension(name) && name != k_image_light)
            root_.fail("extensionsRequired", fmt::format("{} is not supported", printable(name, 60)));
    for (const std::string& name : root_.texts("extensionsUsed"))
        if (name == k_image_light)
            document_.warnings.push_back(
                "the file's own light from all around is left out: give the file as the environment");
        else if (!known_extension(name))
            document_.warnings.push_back(fmt::format("{} is not supported: left out", printable(name, 60)));
}

void DocumentParser::read_buffers() {
    for (JsonFields& fields : root_.array("buffers"))
        document_.buffers.push_back({fields.text("uri"), fields.require("byteLength").size("byteLength", 0)});
    for (JsonFields& fields : root_.array("bufferViews")) document_.views.push_back(read_view(fields));
    for (JsonFields& fields : root_.array("accessors")) document_.accessors.push_back(read_accessor(fields));
}

GltfView DocumentParser::read_view(JsonFields& fields) {
    GltfView view;
    view.buffer = fields.require("buffer").index("buffer", document_.buffers.size());
    view.offset = fields.size("byteOffset", 0);
    view.length = fields.require("byteLength").size("byteLength", 0);
    view.stride = fields.size("byteStride", 0);
    if (view.stride > 252) fields.fail("byteStride", "is over 252");
    if (JsonFields packed = fields.extension("EXT_meshopt_compression")) {
        GltfMeshopt m;
        m.buffer = packed.require("buffer").index("buffer", document_.buffers.size());
        m.offset = packed.size("byteOffset", 0);
        m.length = packed.require("byteLength").size("byteLength", 0);
        m.stride = packed.require("byteStride").size("byteStride", 0);
        m.count = packed.require("count").size("count", 0);
        m.mode = packed.require("mode").text("mode");
        m.filter = packed.text("filter", "NONE");
        view.meshopt = m;
    }
    return view;
}

GltfAccessor DocumentParser::read_accessor(JsonFields& fields) {
    GltfAccessor a;
    a.view = fields.index("bufferView", document_.views.size());
    a.offset = fields.size("byteOffset", 0);
    a.count = fields.require("count").size("count", 0);
    a.component =
        int(std::min<std::uint64_t>(fields.require("componentType").size("componentType", gltf_f32), 1 << 20));
    if (!gltf_component_bytes(a.component)) fields.fail("componentType", fmt::format("there is no {}", a.component));
    a.components = components_of(fields.require("type").text("type", "SCALAR"));
    if (a.components == 0) fields.fail("type", "is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
    a.normalized = fields.flag("normalized", false);
    if (JsonFields sparse = fields.object("sparse")) {
        GltfAccessor::Sparse s;
        s.count = sparse.require("count").size("count", 0);
        JsonFields indices = sparse.require("indices").object("indices"),
                   values = sparse.require("values").object("values");
        s.index_view = indices.require("bufferView").index("bufferView", document_.views.size());
        s.index_offset = indices.size("byteOffset", 0);
        s.index_component =
            int(std::min<std::uint64_t>(indices.require("componentType").size("componentType", 0), 1 << 20));
        s.value_view = values.require("bufferView").index("bufferView", document_.views.size());
        s.value_offset = values.size("byteOffset", 0);
        if (s.count > a.count) sparse.fail("count", "is over the accessor's");
        a.sparse = s;
    }
    return a;
}

GltfPrimitive DocumentParser::read_primitive(JsonFields& fields, std::size_t materials) {
    const std::size_t accessors = document_.accessors.size();
    GltfPrimitive p;
    p.attributes = fields.require("attributes").object("attributes").named_indices(accessors);
    p.indices = fields.index("indices", accessors);
    p.material = fields.index("material", materials);
    p.mode = int(std::min<std::uint64_t>(fields.size("mode", 4), 7));
    if (p.mode > 6) fields.fail("mode", "is none of 0 to 6");
    for (JsonFields& target : fields.array("targets")) p.targets.push_back(target.named_indices(accessors));
    if (JsonFields draco = fields.extension("KHR_draco_mesh_compression")) {
        p.draco_view = draco.require("bufferView").index("bufferView", document_.views.size());
        p.draco_attributes = draco.require("attributes").object("attributes").named_indices(std::size_t(1) << 30);
    }
    return p;
}

void DocumentParser::read_meshes() {
    const std::size_t materials = root_.array("materials").size();
    for (JsonFields& fields : root_.array("meshes")) {
        GltfMesh mesh;
        mesh.name = fields.text("name");
        mesh.weights = fields.numbers("weights", 0);
        for (JsonFields& primitive : fields.array("primitives"))
            mesh.primitives.push_back(read_primitive(primitive, materials));
        document_.meshes.push_back(std::move(mesh));
    }
}

GltfNode DocumentParser::read_node(JsonFields& fields, std::size_t nodes, std::size_t lights) {
    GltfNode node;
    node.name = fields.text("name");
    node.mesh = fields.index("mesh", document_.meshes.size());
    node.skin = fields.index("skin", document_.skins.size());
    node.camera = fields.index("camera", document_.cameras.size());
    node.light = fields.extension("KHR_lights_punctual").index("light", lights);
    node.children = fields.indices("children", nodes);
    node.weights = fields.numbers("weights", 0);
    if (const std::vector<float> m = fields.numbers("matrix", 16); !m.empty()) {  // by columns
        node.to_parent = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
        if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
            fields.fail("matrix", "is not affine: its last row is not 0 0 0 1");
    } else {
        const std::vector<float> t = fields.numbers("translation", 3), r = fields.numbers("rotation", 4),
                                 s = fields.numbers("scale", 3);
        const Vec3f translation = t.empty() ? Vec3f{} : Vec3f{t[0], t[1], t[2]};
        const Vec3f scale = s.empty() ? Vec3f{1, 1, 1} : Vec3f{s[0], s[1], s[2]};
        node.to_parent = affine_of_trs(
            translation, r.empty() ? std::array<float, 4>{0, 0, 0, 1} : std::array<float, 4>{r[0], r[1], r[2], r[3]},
            scale);
    }
    if (JsonFields instancing = fields.extension("EXT_mesh_gpu_instancing")) {
        node.instanced = true;
        node.instances =
            instancing.require("attributes").object("attributes").named_indices(document_.accessors.size());
    }
    return node;
}

void DocumentParser::read_skins(std::size_t nodes) {
    for (JsonFields& fields : root_.array("skins"))
        document_.skins.push_back({fields.index("inverseBindMatrices", document_.accessors.size()),
                                   fields.require("joints").indices("joints", nodes)});
}

void DocumentParser::read_orthographic(JsonFields& fields, Camera& camera) {
    JsonFields lens = fields.require("orthographic").object("orthographic");
    camera.orthographic = true;
    camera.half_height = std::abs(lens.require("ymag").number("ymag", 1));
    const float half_width = std::abs(lens.number("xmag", 0));
    for (const auto& [key, size] : {std::pair{"ymag", camera.half_height}, {"xmag", half_width}})
        if (!(size < k_largest_coordinate))
            lens.fail(key, fmt::format("is {:g}, but must be below {:g} metres", size, k_largest_coordinate));
    if (camera.half_height == 0)
        lens.fail("ymag", "is 0");
    else
        camera.aspect = std::clamp(half_width / camera.half_height, 0.0f, k_largest_aspect);
}

void DocumentParser::read_cameras() {
    for (JsonFields& fields : root_.array("cameras")) {
        Camera camera;
        camera.name = fields.text("name");
        const std::string type = fields.require("type").text("type");
        if (type == "orthographic") {
            read_orthographic(fields, camera);
        } else if (type == "perspective") {
            camera.fov_y =
                fields.require("perspective").object("perspective").require("yfov").number("yfov", camera.fov_y);
            camera.aspect = fields.object("perspective").number("aspectRatio", 0, 0, k_largest_aspect);
            if (!(camera.fov_y > 0 && camera.fov_y < float(k_pi)))
                fields.fail("perspective.yfov", "is not between 0 and pi");
        } else {
            fields.fail("type", "is neither perspective nor orthographic");
        }
        document_.cameras.push_back(std::move(camera));
    }
}

void DocumentParser::read_lights() {
    const JsonFields asset = root_.object("asset");
    // Extras may hold anything: what is no scale of intensities counts as missing.
    const auto stated = [](const JsonFields& fields) {
        const std::optional<float> lux = fields.number_in("extras", "lux_per_unit");
        return lux && *lux >= 1e-20f && *lux <= 1e20f ? lux : std::nullopt;
    };
    const float lux_per_unit = stated(asset).value_or(options_.lux_per_unit);
    document_.rotate_y_deg = asset.number_in("extras", "rotate_y_deg").value_or(0);
    for (JsonFields& fields : root_.extension("KHR_lights_punctual").array("lights")) {
        PunctualLight light;
        light.name = fields.text("name");
        const std::vector<float> c = fields.numbers("color", 3);
        const Vec3f colour =
            c.empty() ? Vec3f{1, 1, 1} : Vec3f{std::max(c[0], 0.0f), std::max(c[1], 0.0f), std::max(c[2], 0.0f)};
        light.intensity = colour * (fields.number("intensity", 1, 0, 1e15f) / stated(fields).value_or(lux_per_unit));
        if (const float range = fields.number("range", 0); range > 0) light.range = range;
        const std::string type = fields.require("type").text("type");
        if (type == "directional") {
            light.kind = PunctualLight::Kind::directional;
        } else if (type == "point") {
            light.kind = PunctualLight::Kind::point;
        } else if (type == "spot") {
            light.kind = PunctualLight::Kind::spot;
            JsonFields cone = fields.object("spot");
            const float outer = cone.number("outerConeAngle", float(k_pi / 4), 1e-4f, float(k_pi / 2));
            light.cos_outer = std::cos(outer);
            light.cos_inner = std::cos(cone.number("innerConeAngle", 0, 0, outer));
        } else {
            fields.fail("type", "is none of directional, point and spot");
        }
        document_.lights.push_back(std::move(light));
    }
}

void DocumentParser::read_images_and_materials() {
    for (JsonFields& fields : root_.array("images")) {
        GltfImage image{fields.text("name"), fields.text("uri"), fields.text("mimeType"),
                        fields.index("bufferView", document_.views.size())};
        if (image.uri.empty() == (image.view < 0)) fields.fail("", "names neither or both of uri and bufferView");
        document_.images.push_back(std::move(image));
    }
    const std::vector<SceneTexture> textures = read_gltf_textures(root_, document_.images.size(), document_.warnings);
    for (const JsonFields& fields : root_.array("materials"))
        document_.materials.push_back(read_gltf_material(fields, textures, document_.warnings));
}

/// Parents from children, and proof that the nodes are a forest.
void DocumentParser::set_parents() {
    std::vector<GltfNode>& nodes = document_.nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (const int child : nodes[n].children) {
            int& parent = nodes[std::size_t(child)].parent;
            if (parent >= 0)
                return root_.fail(fmt::format("nodes[{}]", child),
                                  fmt::format("is a child of nodes {} and {}", parent, n));
            parent = int(n);
        }
    // Since each node has one parent, a walk upwards ends at a root or is cyclic; nodes already visited are not visited
    // again.
    std::vector<int> walk(nodes.size(), -1);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (int at = int(n); at >= 0; at = nodes[std::size_t(at)].parent) {
            if (walk[std::size_t(at)] == int(n)) return root_.fail(fmt::format("nodes[{}]", at), "is its own ancestor");
            if (walk[std::size_t(at)] >= 0) break;
            walk[std::size_t(at)] = int(n);
        }
}

void DocumentParser::read_roots() {
    const std::vector<GltfNode>& nodes = document_.nodes;
    std::vector<JsonFields> scenes = root_.array("scenes");
    int shown = root_.index("scene", scenes.size());
    if (shown < 0 && !scenes.empty()) shown = 0;
    if (shown >= 0) {
        document_.roots = scenes[std::size_t(shown)].indices("nodes", nodes.size());
        std::vector<bool> seen(nodes.size());
        for (const int root : document_.roots) {
            if (nodes[std::size_t(root)].parent >= 0)
                scenes[std::size_t(shown)].fail("nodes", fmt::format("node {} is not a root", root));
            if (seen[std::size_t(root)])
                scenes[std::size_t(shown)].fail("nodes", fmt::format("node {} is there twice", root));
            seen[std::size_t(root)] = true;
        }
    } else {
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (nodes[n].parent < 0) document_.roots.push_back(int(n));
    }
}

Result<GltfDocument> DocumentParser::parse() {
    if (!root_) return Error{"the JSON is not an object", "", ""};
    read_asset();
    read_buffers();
    read_meshes();
    std::vector<JsonFields> nodes = root_.array("nodes");
    read_skins(nodes.size());
    read_cameras();
    read_lights();
    for (JsonFields& fields : nodes)
        document_.nodes.push_back(read_node(fields, nodes.size(), document_.lights.size()));
    read_images_and_materials();
    if (error_) return *error_;
    set_parents();
    if (error_) return *error_;
    read_roots();
    if (error_) return *error_;
    return std::move(document_);
}

}  // namespace

int gltf_attribute(const GltfAttributes& attributes, std::string_view semantic) {
    for (const auto& [name, number] : attributes)
        if (name == semantic) return number;
    return -1;
}

Affine affine_of_trs(const Vec3f& translation, const std::array<float, 4>& rotation, const Vec3f& scale) {
    double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
    const double n = std::sqrt(x * x + y * y + z * z + w * w);
    if (n > 0)
        x /= n, y /= n, z /= n, w /= n;
    else
        w = 1;
    // The images of the axes under v -> q v q*.
    const Vec3d ax{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    const Vec3d ay{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    const Vec3d az{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    return {Vec3f(ax * scale.x), Vec3f(ay * scale.y), Vec3f(az * scale.z), translation};
}

Result<GltfDocument> parse_gltf_document(std::string_view text, const SceneOptions& options) {
    const auto json = parse_json(text);
    if (!json) return json.error();
    return DocumentParser(*json, options).parse();
}

}  // namespace domelight
