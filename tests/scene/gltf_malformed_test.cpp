#include "gltf_samples.h"

#include <fstream>
#include <iterator>

using namespace domelight;
using namespace domelight::test;

namespace {

GltfSample indexed() {
    GltfSample sample;
    Json primitive = sample.triangle();
    primitive["indices"] = sample.accessor(std::vector<std::uint32_t>{0, 1, 2}, "SCALAR");
    sample.show(std::move(primitive));
    return sample;
}

/// The error after `value` is put at `pointer` of a scene that loads.
std::string after(const char* pointer, Json value) {
    GltfSample sample = indexed();
    sample.text();
    if (!sample.json.contains("buffers")) (void)sample.load();
    sample.json["buffers"] =
        Json::array({{{"byteLength", sample.data.size()}, {"uri", "data:;base64," + base64(sample.data)}}});
    sample.json[Json::json_pointer(pointer)] = std::move(value);
    return error_of(sample.load());
}

}  // namespace

TEST_CASE("gltf malformed: each kind of lie is named with its place") {
    CHECK(after("/extras", 1) == "loaded");
    CHECK(contains(after("/asset/version", "1.0"), "only glTF 2.0"));
    CHECK(contains(after("/asset", Json::object()), "asset.version: is missing"));
    CHECK(contains(after("/extensionsRequired", {"KHR_texture_basisu"}), "KHR_texture_basisu is not supported"));
    CHECK(contains(after("/meshes/0/primitives/0/attributes/POSITION", 9),
                   "meshes[0].primitives[0].attributes.POSITION: there is no 9"));
    CHECK(contains(after("/meshes/0/primitives/0/attributes/POSITION", -1), "is not a whole number"));
    CHECK(contains(after("/meshes/0/primitives/0/attributes", Json::object()), "there are no positions"));
    CHECK(contains(after("/meshes/0/primitives/0/mode", 7), "mode"));
    CHECK(contains(after("/meshes/0/primitives/0/indices", 4294967296), "there is no 4294967296"));
    CHECK(contains(after("/nodes/0/mesh", "0"), "nodes[0].mesh"));
    CHECK(contains(after("/nodes/0", 5), "nodes[0]: is not an object"));
    CHECK(contains(after("/nodes/0/matrix", {1, 2, 3}), "is not 16 numbers"));
    CHECK(contains(after("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), "not affine"));
    CHECK(contains(after("/nodes/0/translation", {1e300, 0, 0}), "nodes[0].translation"));
    CHECK(contains(after("/accessors/0/componentType", 5124), "there is no 5124"));
    CHECK(contains(after("/accessors/0/type", "VEC5"), "accessors[0].type"));
    CHECK(contains(after("/accessors/0/count", 4), "do not fit"));
    CHECK(contains(after("/accessors/0/count", 1e15), "do not fit"));
    CHECK(contains(after("/accessors/0/count", 18446744073709551615u), "do not fit"));
    CHECK(contains(after("/accessors/0/byteOffset", 18446744073709551600u), "do not fit"));
    CHECK(contains(after("/accessors/1/componentType", 5126), "indices are not scalars"));
    CHECK(contains(after("/accessors/1/count", 1 << 30), "do not fit"));
    CHECK(contains(after("/bufferViews/0/byteLength", 1 << 30), "bufferViews[0]: bytes"));
    CHECK(contains(after("/bufferViews/0/byteOffset", 18446744073709551615u), "bufferViews[0]: bytes"));
    CHECK(contains(after("/bufferViews/0/byteStride", 8), "lie 8 bytes apart"));
    CHECK(contains(after("/buffers/0/byteLength", 1e12), "byteLength is"));
    CHECK(contains(after("/buffers/0/uri", "data:;base64,A*=="), "not base64"));
    CHECK(contains(after("/scene", 3), "scene: there is no 3"));
    CHECK(contains(after("/nodes/0/mesh", nullptr), "nodes[0].mesh"));
    CHECK(contains(after("/nodes", Json::array()), "no triangles"));
    CHECK(contains(after("/scenes", {{{"nodes", {0, 0}}}}), "twice"));
}

TEST_CASE("gltf malformed: indices past the vertices, and accessors of nothing") {
    GltfSample sample = indexed();
    sample.data[36 + 8] = 3;
    CHECK(contains(error_of(sample.load()), "index 3, but there are 3 vertices"));
    GltfSample restart = indexed();
    for (int i = 0; i < 4; ++i) restart.data[std::size_t(36 + i)] = 0xff;
    CHECK(contains(error_of(restart.load()), "index 4294967295"));
    // Accessors of zeros without data may not be large.
    GltfSample zeros = indexed();
    zeros.json["accessors"][0].erase("bufferView");
    zeros.json["accessors"][0]["count"] = std::uint64_t(1) << 40;
    CHECK(contains(error_of(zeros.load()), "elements of no data"));
    CHECK(contains(error_of(indexed().load({.max_bytes = 20})), "limit of 20 bytes"));
}

TEST_CASE("gltf malformed: nodes in a circle, with two parents, and very deep ones") {
    const auto nodes = [](Json list) {
        GltfSample sample = indexed();
        sample.json["nodes"] = std::move(list);
        return error_of(sample.load());
    };
    CHECK(contains(nodes({{{"children", {1}}}, {{"children", {0}}}}), "is its own ancestor"));
    CHECK(contains(nodes({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}}), "is its own ancestor"));
    CHECK(contains(nodes({{{"children", {0}}}}), "is its own ancestor"));
    CHECK(contains(nodes({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}}), "is a child of nodes 0 and 1"));
    CHECK(contains(nodes({{{"children", {1, 1}}}, {{"mesh", 0}}}), "is a child of nodes 0 and 0"));
    GltfSample deep = indexed();
    deep.json["nodes"] = Json::array();
    for (int i = 0; i < 50000; ++i) deep.json["nodes"].push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    deep.json["nodes"].push_back({{"mesh", 0}});
    const auto scene = deep.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(scene->instances[0].to_world.translation.x == 50000);
    // Transforms beyond the range of float are left out.
    GltfSample far = indexed();
    far.json["nodes"] = {
        {{"scale", {1e30, 1, 1}}, {"children", {1}}}, {{"scale", {1e30, 1, 1}}, {"mesh", 0}}, {{"mesh", 0}}};
    const auto mended = far.load();
    REQUIRE_MESSAGE(mended, error_of(mended));
    CHECK(mended->instances.size() == 1);
    CHECK(warns(*mended, "their place is not finite"));
    // A scale of 0 in one direction is not an error.
    GltfSample flat = indexed();
    flat.json["nodes"][0]["scale"] = {1, 1, 0};
    CHECK(error_of(flat.load()) == "loaded");
}

TEST_CASE("gltf malformed: cameras, vertices and places that rays would leave the range of float for") {
    const auto camera = [](Json lens) {
        GltfSample sample = indexed();
        sample.add("cameras", {{"type", "orthographic"}, {"orthographic", std::move(lens)}});
        sample.add("nodes", {{"camera", 0}});
        return sample.load();
    };
    CHECK(contains(error_of(camera({{"xmag", 1}, {"ymag", 1e19}})),
                   "cameras[0].orthographic.ymag: is 1e+19, but must be below 1e+09 metres"));
    CHECK(contains(error_of(camera({{"xmag", 1e19}, {"ymag", 1}})), "cameras[0].orthographic.xmag: is 1e+19"));
    CHECK(contains(error_of(camera({{"xmag", 1}, {"ymag", 0}})), "cameras[0].orthographic.ymag: is 0"));
    const auto flat = camera({{"xmag", 1e8}, {"ymag", 1e-30}});
    REQUIRE_MESSAGE(flat, error_of(flat));
    CHECK(flat->cameras[0].aspect == 1e6f);

    // In range by themselves, but not together.
    GltfSample far;
    far.show({{"attributes", {{"POSITION", far.accessor(std::vector<float>{0, 0, 0, 1e6f, 0, 0, 0, 1, 0}, "VEC3")}}}},
             {{"scale", {1e6, 1, 1}}});
    far.add("nodes", {{"mesh", 0}});
    const auto mended = far.load();
    REQUIRE_MESSAGE(mended, error_of(mended));
    CHECK(mended->instances.size() == 1);
    CHECK(warns(*mended, "1 nodes left out: their place"));
}

TEST_CASE("gltf malformed: instances are counted, and the same place is taken once") {
    GltfSample sample = indexed();
    for (int i = 0; i < 9; ++i) sample.add("nodes", {{"mesh", 0}, {"translation", {i / 3, 0, 0}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(scene->instances.size() == 3);
    CHECK(warns(*scene, "7 instances left out: the same mesh stands in exactly the same place"));
    // A flattened instance gets triangles of its own, which count towards the limit.
    for (Json& node : sample.json["nodes"]) node["scale"] = {1, 1, 0};
    CHECK(contains(error_of(sample.load({.max_bytes = 3000})), "instances would take the scene over the limit"));

    GltfSample many = indexed();
    std::vector<float> places(3 * ((1 << 20) + 1));
    for (std::size_t i = 0; i < places.size(); i += 3) places[i] = float(i);
    many.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        many.accessor(places, "VEC3");
    CHECK(contains(error_of(many.load()), "meshes stand more than 1048576 times in the scene"));
    CHECK(many.load({.max_instances = (1 << 20) + 1}));
    CHECK(contains(error_of(sample.load({.max_instances = 2})), "meshes stand more than 2 times in the scene"));
    CHECK(sample.load({.max_instances = 3}));
}

TEST_CASE("gltf malformed: broken JSON and broken containers") {
    CHECK(contains(error_of(load_text("{\"asset\":", "a.gltf")), "a.gltf: broken JSON: parse error at line 1"));
    CHECK(contains(error_of(load_text("[]", "a.gltf")), "not an object"));
    CHECK(contains(error_of(load_text(std::string(200000, '['), "a.gltf")), "broken JSON"));
    CHECK(contains(error_of(load_text(std::string(100000, '[') + std::string(100000, ']'), "a.gltf")),
                   "nested more than 256 deep"));
    CHECK(contains(error_of(load_text("", "a.gltf")), "empty"));
    CHECK(contains(error_of(load_text("glTF", "a.glb")), "ends too early"));
    CHECK(contains(error_of(load_text(std::string("glTF\1\0\0\0\24\0\0\0\0\0\0\0JSON", 20), "a.glb")), "version 1"));
    CHECK(contains(error_of(load_text(std::string("glTF\2\0\0\0\377\0\0\0\0\0\0\0JSON", 20), "a.glb")),
                   "header says 255"));
    CHECK(contains(error_of(load_text(std::string("glTF\2\0\0\0\24\0\0\0\7\0\0\0JSON", 20), "a.glb")),
                   "a chunk of 7 bytes"));
    CHECK(contains(error_of(load_text(std::string("glTF\2\0\0\0\24\0\0\0\0\0\0\0BIN\0", 20), "a.glb")), "not JSON"));
    CHECK(contains(error_of(load_text("x", "a.fbx")), "not a kind of scene"));
    CHECK(contains(error_of(load_scene("/nowhere/at/all.glb")), "no such file"));
}

TEST_CASE("gltf malformed: files that a validator must refuse give an error or a scene") {
    const auto folder = data_folder();
    if (!folder || !std::filesystem::exists(*folder / "malformed"))
        return note_skip("DOMELIGHT_DATA has no malformed files");
    int files = 0;
    for (const char* place : {"gltf_validator", "gltf_tinygltf"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "malformed" / place)) {
            if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
            INFO(entry.path().string());
            ++files;
            const auto scene = load_scene(entry.path());
            if (scene)
                CHECK(scene->triangle_count() > 0);
            else
                CHECK(contains(scene.error().format(), entry.path().filename().string()));
        }
    CHECK(files > 100);
}

TEST_CASE("gltf malformed: a model cut anywhere, or with bytes changed, does no harm") {
    GltfSample sample = indexed();
    const std::string whole = sample.text();
    for (std::size_t keep = 0; keep < whole.size(); keep += 3) CHECK(!load_text(whole.substr(0, keep), "a.gltf"));
    std::uint64_t state = 1;
    for (int i = 0; i < 400; ++i) {
        std::string changed = whole;
        state = state * 6364136223846793005u + 1442695040888963407u;
        changed[(state >> 33) % changed.size()] = char('!' + (state >> 20) % 90);
        const auto scene = load_text(changed, "a.gltf");
        if (scene) CHECK(scene->triangle_count() > 0);
    }
}
