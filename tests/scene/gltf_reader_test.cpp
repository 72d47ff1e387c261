#include "gltf_samples.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>
#include <fstream>

using namespace domelight;
using namespace domelight::test;

namespace {

const float k_half = std::sqrt(0.5f);

/// The corners of a mesh's first triangle in the world.
std::vector<Vec3f> corners(const Scene& scene, std::size_t instance = 0) {
    const Instance& in = scene.instances[instance];
    const Mesh& mesh = scene.meshes[std::size_t(in.mesh)];
    std::vector<Vec3f> out;
    for (const std::uint32_t i : mesh.indices) out.push_back(in.to_world.point(mesh.positions[i]));
    return out;
}

std::string glb(GltfSample sample) {
    sample.json["buffers"] = Json::array({{{"byteLength", sample.data.size()}}});
    std::string json = sample.json.dump();
    while (json.size() % 4) json += ' ';
    while (sample.data.size() % 4) sample.data.push_back(0);
    std::string out = "glTF";
    const auto number = [&](std::size_t n) {
        for (int i = 0; i < 4; ++i) out += char(n >> (8 * i));
    };
    number(2), number(28 + json.size() + sample.data.size());
    number(json.size()), out += "JSON" + json;
    number(sample.data.size()), out += std::string("BIN\0", 4);
    out.append(sample.data.begin(), sample.data.end());
    return out;
}

/// A mesh of n x n quads over the unit square, as a meshlet-worthy size.
struct Grid {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    explicit Grid(std::uint32_t n) {
        for (std::uint32_t y = 0; y <= n; ++y)
            for (std::uint32_t x = 0; x <= n; ++x) {
                positions.push_back(float(x) / float(n));
                positions.push_back(float(y) / float(n));
                positions.push_back(0.25f * float(x * y % 3));
            }
        for (std::uint32_t y = 0; y < n; ++y)
            for (std::uint32_t x = 0; x < n; ++x) {
                const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 2, d = a + n + 1;
                indices.insert(indices.end(), {a, b, c, a, c, d});
            }
    }
};

}  // namespace

TEST_CASE("gltf: a triangle without indices, in text and binary form") {
    GltfSample sample;
    sample.show(sample.triangle(), {{"name", "thing"}});
    for (const bool binary : {false, true}) {
        auto scene = binary ? load_text(glb(sample), "a.glb") : sample.load();
        REQUIRE_MESSAGE(scene, error_of(scene));
        CHECK(scene->triangle_count() == 1);
        CHECK(scene->instances[0].name == "thing");
        CHECK(corners(*scene) == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(scene->meshes[0].normals.empty());
        CHECK(scene->warnings.empty());
        // glTF's default material.
        CHECK(scene->materials[std::size_t(scene->meshes[0].material)].metalness == 1);
        CHECK(scene->materials[std::size_t(scene->meshes[0].material)].roughness == 1);
    }
}

TEST_CASE("gltf: node transforms, by matrix and by translation, rotation, scale") {
    GltfSample sample;
    // A quarter turn about +z takes x to y; then scale acts first: 2x becomes 2y.
    sample.show(sample.triangle(),
                {{"translation", {10, 20, 30}}, {"rotation", {0, 0, k_half, k_half}}, {"scale", {2, 3, 4}}});
    sample.show(sample.triangle(), {{"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1}}});
    // x, y and z turn differently, so the order of a quaternion's components matters: a third of a turn about (1,1,1)
    // takes x to y to z.
    sample.show(sample.triangle(), {{"rotation", {0.5, 0.5, 0.5, 0.5}}});
    // A child of a moved, turned parent.
    const int child = sample.show(sample.triangle(), {{"translation", {1, 0, 0}}});
    const int parent =
        sample.add("nodes", {{"children", {child}}, {"rotation", {0, 0, k_half, k_half}}, {"translation", {0, 0, 5}}});
    sample.json["scenes"] = Json::array({{{"nodes", {0, 1, 2, parent}}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->instances.size() == 4);
    for (const std::size_t i : {std::size_t(0), std::size_t(1)}) {
        CHECK(near(corners(*scene, i)[0], {10, 20, 30}));
        CHECK(near(corners(*scene, i)[1], {10, 22, 30}, 1e-5f));
        CHECK(near(corners(*scene, i)[2], {7, 20, 30}, 1e-5f));
    }
    CHECK(near(corners(*scene, 2)[1], {0, 1, 0}));
    CHECK(near(corners(*scene, 2)[2], {0, 0, 1}));
    CHECK(near(corners(*scene, 3)[0], {0, 1, 5}));
    CHECK(near(corners(*scene, 3)[1], {0, 2, 5}));
}

TEST_CASE("gltf: strips and fans become the triangles of the specification") {
    GltfSample sample;
    const int positions = sample.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f, 0, 2, 0}, "VEC3");
    const int indices = sample.accessor(std::vector<std::uint16_t>{0, 1, 2, 3, 4}, "SCALAR");
    sample.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 5}});
    sample.show({{"attributes", {{"POSITION", positions}}}, {"mode", 6}});
    sample.show({{"attributes", {{"POSITION", positions}}}, {"mode", 1}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->meshes.size() == 2);
    CHECK(scene->meshes[0].indices == std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4});
    CHECK(scene->meshes[1].indices == std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0});
    CHECK(warns(*scene, "points or lines"));
}

TEST_CASE("gltf: primitives that share an array keep their part of it") {
    GltfSample sample;
    const int positions = sample.accessor(std::vector<float>{9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 8, 8, 8}, "VEC3");
    const int indices = sample.accessor(std::vector<std::uint8_t>{1, 2, 3}, "SCALAR");
    sample.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(scene->meshes[0].positions.size() == 3);
    CHECK(corners(*scene) == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("gltf: normalised and plain integers, interleaved") {
    GltfSample sample;
    // Per vertex: position as 3 x i16 (normalised) and padding, normal as 3 x i8 and padding, colour as 4 x u8.
    std::vector<std::uint8_t> packed;
    const auto put16 = [&](std::int16_t v) {
        packed.push_back(std::uint8_t(v)), packed.push_back(std::uint8_t(v >> 8));
    };
    const std::int16_t positions[3][3] = {{0, 0, 0}, {32767, 0, -32768}, {0, 16384, 0}};
    for (const auto& p : positions) {
        for (const std::int16_t c : p) put16(c);
        put16(0);
        for (const std::int8_t c : {0, 0, 127, 0}) packed.push_back(std::uint8_t(c));
        for (const std::uint8_t c : {255, 51, 0, 128}) packed.push_back(c);
    }
    const int view = sample.view(packed, 16);
    const auto accessor = [&](int offset, int code, const char* type) {
        return sample.add("accessors", {{"bufferView", view},
                                        {"byteOffset", offset},
                                        {"componentType", code},
                                        {"count", 3},
                                        {"type", type},
                                        {"normalized", true}});
    };
    const int p = accessor(0, 5122, "VEC3"), n = accessor(8, 5120, "VEC3"), c = accessor(12, 5121, "VEC4");
    sample.show({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"COLOR_0", c}}}});
    // The same numbers not normalised are metres.
    sample.json["accessors"].push_back(sample.json["accessors"][0]);
    sample.json["accessors"][3]["normalized"] = false;
    sample.show({{"attributes", {{"POSITION", 3}}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    const Mesh& mesh = scene->meshes[0];
    // c / 32767, and -32768 is -1 as well.
    CHECK(mesh.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, -1}, {0, 16384.0f / 32767, 0}});
    CHECK(mesh.normals == std::vector<Vec3f>(3, {0, 0, 1}));
    CHECK(mesh.colors[1].rgb == Vec3f{1, 0.2f, 0});
    CHECK(mesh.colors[1].a == 128.0f / 255);
    CHECK(scene->meshes[1].positions[1] == Vec3f{32767, 0, -32768});
}

TEST_CASE("gltf: sparse accessors, over data and over zeros") {
    GltfSample sample;
    sample.json["accessors"] = Json::array();
    const int base = sample.accessor(std::vector<float>{8, 8, 8, 1, 0, 0, 7, 7, 7}, "VEC3");
    const int where = sample.view(bytes_of(std::vector<std::uint16_t>{0, 2}));
    const int what = sample.view(bytes_of(std::vector<float>{0, 0, 0, 0, 1, 0}));
    const Json sparse = {{"count", 2},
                         {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                         {"values", {{"bufferView", what}}}};
    sample.json["accessors"][std::size_t(base)]["sparse"] = sparse;
    sample.show({{"attributes", {{"POSITION", base}}}});
    const int zeros =
        sample.add("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    Json morphed = sample.triangle();
    morphed["targets"] = Json::array({{{"POSITION", zeros}}});
    sample.show(std::move(morphed), {{"weights", {2}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(corners(*scene, 0)[0] == Vec3f{0, 0, 0});
    CHECK(corners(*scene, 0)[2] == Vec3f{0, 1, 0});
    CHECK(corners(*scene, 1)[1] == Vec3f{1, 0, 0});
    CHECK(corners(*scene, 1)[2] == Vec3f{0, 3, 0});
}

TEST_CASE("gltf: morph targets by the mesh's weights, unless the node has its own") {
    GltfSample sample;
    Json primitive = sample.triangle();
    primitive["attributes"]["NORMAL"] = sample.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int up = sample.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int aside = sample.accessor(std::vector<float>{4, 0, 0, 4, 0, 0, 4, 0, 0}, "VEC3");
    const int tilt = sample.accessor(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    primitive["targets"] = Json::array({{{"POSITION", up}, {"NORMAL", tilt}}, {{"POSITION", aside}}});
    const int mesh = sample.add("meshes", {{"primitives", Json::array({primitive})}, {"weights", {0.5, 0.25}}});
    sample.add("nodes", {{"mesh", mesh}});
    sample.add("nodes", {{"mesh", mesh}, {"weights", {0, 1}}});
    sample.add("nodes", {{"mesh", mesh}, {"translation", {7, 0, 0}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->instances.size() == 3);
    CHECK(corners(*scene, 0)[0] == Vec3f{1, 0, 0.5f});
    CHECK(near(scene->meshes[0].normals[0], normalize(Vec3f{0.5f, 0, 1})));
    CHECK(corners(*scene, 1)[0] == Vec3f{4, 0, 0});
    CHECK(scene->instances[2].mesh == scene->instances[0].mesh);
}

TEST_CASE("gltf: a skin at rest is its joints' matrices times the inverse bind matrices") {
    GltfSample sample;
    Json primitive = sample.triangle();
    primitive["attributes"]["NORMAL"] = sample.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    primitive["attributes"]["JOINTS_0"] =
        sample.accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
    // Vertex 0 by joint 0, vertex 1 by joint 1, vertex 2 half by each, with weights that sum to 2.
    primitive["attributes"]["WEIGHTS_0"] =
        sample.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0}, "VEC4");
    const std::vector<float> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<float> inverse = identity;
    inverse.insert(inverse.end(), identity.begin(), identity.end());
    inverse[16 + 12] = -1;  // joint 1 was bound at x = 1
    const int bind = sample.accessor(inverse, "MAT4");
    // Joint 0 is 10 up; joint 1, its child at x = 1, turns x to z (a quarter about -y).
    sample.add("nodes", {{"translation", {0, 10, 0}}, {"children", {1}}});
    sample.add("nodes", {{"translation", {1, 0, 0}}, {"rotation", {0, -k_half, 0, k_half}}});
    sample.add("skins", {{"joints", {0, 1}}, {"inverseBindMatrices", bind}});
    // The position of the node itself does not matter.
    sample.show(std::move(primitive), {{"skin", 0}, {"translation", {100, 100, 100}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    const std::vector<Vec3f> at = corners(*scene);
    CHECK(near(at[0], {0, 10, 0}, 1e-5f));
    CHECK(near(at[1], {1, 10, 0}, 1e-5f));  // (1,0,0) is the bind place of joint 1, which is at (1,10,0)
    // (0,1,0): joint 0 gives (0,11,0); joint 1 turns (-1,1,0) into (0,1,-1) and puts it at (1,11,-1).
    CHECK(near(at[2], {0.5f, 11, -0.5f}, 1e-5f));
    CHECK(near(scene->meshes[0].normals[1], {-1, 0, 0}, 1e-5f));
}

TEST_CASE("gltf: instances of EXT_mesh_gpu_instancing") {
    GltfSample sample;
    const int t = sample.accessor(std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3");
    const int s = sample.accessor(std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3");
    sample.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    sample.show(sample.triangle(),
                {{"translation", {0, 0, 5}},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", t}, {"SCALE", s}}}}}}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->instances.size() == 3);
    CHECK(scene->meshes.size() == 1);
    CHECK(corners(*scene, 2)[1] == Vec3f{6, 0, 5});
    CHECK(scene->triangle_count() == 3);
}

TEST_CASE("gltf: cameras and lights stand where their nodes are, without scale") {
    GltfSample sample;
    sample.show(sample.triangle());
    sample.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    sample.add("cameras",
               {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0.1}, {"zfar", 9}}}});
    sample.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
        {{"type", "spot"},
         {"intensity", 1366},
         {"range", 7},
         {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
    // A quarter turn about +y takes -z to -x.
    const Json turn = {0, k_half, 0, k_half};
    sample.add("nodes",
               {{"camera", 0}, {"rotation", turn}, {"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}, {"name", "view"}});
    sample.add("nodes", {{"camera", 1}});
    sample.add("nodes", {{"rotation", turn}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    sample.add("nodes", {{"translation", {0, 4, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->cameras.size() == 2);
    CHECK(scene->cameras[0].name == "view");
    CHECK(scene->cameras[0].fov_y == 0.7f);
    CHECK(near(scene->cameras[0].to_world.z, {1, 0, 0}));
    CHECK(near(scene->cameras[0].to_world.y, {0, 1, 0}));
    CHECK(near(scene->cameras[0].to_world.x, {0, 0, -1}));
    CHECK(scene->cameras[0].to_world.translation == Vec3f{1, 2, 3});
    CHECK(scene->cameras[1].orthographic);
    CHECK(scene->cameras[0].aspect == 0);
    CHECK(scene->cameras[1].half_height == 3);
    CHECK(scene->cameras[1].aspect == 2.0f / 3);
    REQUIRE(scene->lights.size() == 2);
    CHECK(near(scene->lights[0].direction, {-1, 0, 0}));
    CHECK(near(scene->lights[0].intensity, {1, 0.5f, 0}));
    CHECK(scene->lights[1].kind == PunctualLight::Kind::spot);
    CHECK(scene->lights[1].position == Vec3f{0, 4, 0});
    CHECK(near(scene->lights[1].intensity, {2, 2, 2}));
    CHECK(scene->lights[1].range == 7);
    CHECK(scene->lights[1].cos_inner == doctest::Approx(std::cos(0.1)));
    CHECK(scene->lights[1].cos_outer == doctest::Approx(std::cos(0.2)));
}

namespace {

/// A triangle and a directional light of 100 lux that shines along -z.
GltfSample lit_triangle() {
    GltfSample sample;
    sample.show(sample.triangle());
    sample.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 100}}};
    sample.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return sample;
}

float intensity_in(GltfSample& sample, const SceneOptions& options = {}) {
    const auto scene = sample.load(options);
    REQUIRE_MESSAGE(scene, error_of(scene));
    REQUIRE(scene->lights.size() == 1);
    return scene->lights[0].intensity.y;
}

}  // namespace

TEST_CASE("gltf: the file says what one unit of irradiance is in lux, else the options, else it is 1 W/m^2") {
    GltfSample sample = lit_triangle();
    SceneOptions options;
    options.lux_per_unit = 50;
    CHECK(intensity_in(sample) == doctest::Approx(100 / 683.0));
    CHECK(intensity_in(sample, options) == doctest::Approx(2));
    sample.json["asset"]["extras"]["lux_per_unit"] = 10;
    CHECK(intensity_in(sample, options) == doctest::Approx(10));
    Json& light = sample.json["extensions"]["KHR_lights_punctual"]["lights"][0];
    light["extras"]["lux_per_unit"] = 1;
    CHECK(intensity_in(sample, options) == doctest::Approx(100));
    // Extras may hold anything: a value that is not a scale counts as missing.
    for (const Json& other : {Json("bright"), Json(0), Json(-1), Json(nullptr), Json::array({1})}) {
        light["extras"]["lux_per_unit"] = other;
        CHECK(intensity_in(sample, options) == doctest::Approx(10));
    }
    light["extras"] = "none";
    CHECK(intensity_in(sample, options) == doctest::Approx(10));
}

TEST_CASE(
    "load_environment_lights: lights of a file with or without triangles, and how far their environment was turned") {
    const TemporaryFolder folder;
    const auto load = [&](GltfSample& sample, const char* name = "lights.gltf") {
        std::ofstream(folder / name) << sample.text();
        return load_environment_lights(folder / name);
    };
    GltfSample sample = lit_triangle();
    sample.json["asset"]["extras"] = {{"lux_per_unit", 1}, {"rotate_y_deg", 30}};
    for (const bool triangles : {true, false}) {
        INFO("with triangles: " << triangles);
        if (!triangles) {
            for (const char* part : {"meshes", "accessors", "bufferViews", "buffers"}) sample.json.erase(part);
            sample.data.clear();
            sample.json["nodes"].erase(sample.json["nodes"].begin());
        }
        const auto found = load(sample);
        REQUIRE(found);
        REQUIRE(found->lights.size() == 1);
        CHECK(found->lights[0].intensity.x == 100);
        CHECK(near(found->lights[0].direction, {0, 0, -1}));
        CHECK(found->rotate_y_deg == 30);
        CHECK(found->warnings.empty());
    }
    GltfSample none;
    const auto empty = load(none);
    REQUIRE(empty);
    CHECK(empty->lights.empty());
    std::ofstream(folder / "lights.json") << "{}";
    CHECK(contains(load_environment_lights(folder / "lights.json").error().format(), "is not a glTF file"));
    std::ofstream(folder / "broken.gltf") << "{";
    CHECK(contains(load_environment_lights(folder / "broken.gltf").error().format(), "broken.gltf"));
}

TEST_CASE("gltf: Draco gives the triangles that were packed") {
    const Grid grid(8);
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(int(grid.indices.size() / 3));
    const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::size_t t = 0; t < grid.indices.size(); t += 3) {
        const auto at = [&](std::size_t k) { return &grid.positions[3 * grid.indices[t + k]]; };
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(std::uint32_t(t / 3)), at(0), at(1), at(2));
    }
    const auto mesh = builder.Finalize();
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        draco::EncoderBuffer packed;
        REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
        GltfSample sample;
        const int view = sample.view({packed.data(), packed.data() + packed.size()});
        const std::size_t vertices = grid.positions.size() / 3;
        sample.add("accessors", {{"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}});
        sample.add("accessors", {{"componentType", 5125}, {"count", grid.indices.size()}, {"type", "SCALAR"}});
        sample.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
        const Json packing = {{"bufferView", view},
                              {"attributes", {{"POSITION", mesh->attribute(attribute)->unique_id()}}}};
        sample.show({{"attributes", {{"POSITION", 0}}},
                     {"indices", 1},
                     {"extensions", {{"KHR_draco_mesh_compression", packing}}}});
        const auto scene = sample.load();
        REQUIRE_MESSAGE(scene, error_of(scene));
        CHECK(scene->triangle_count() == 128);
        CHECK(scene->bounds().low == Vec3f{0, 0, 0});
        CHECK(scene->bounds().high == Vec3f{1, 1, 0.5f});
        // The sum of the areas shows that the surface is the same in any order of the triangles.
        double area = 0, expected = 0;
        const std::vector<Vec3f> c = corners(*scene);
        for (std::size_t i = 0; i < c.size(); i += 3) area += length(cross(c[i + 1] - c[i], c[i + 2] - c[i]));
        for (std::size_t t = 0; t < grid.indices.size(); t += 3) {
            const auto at = [&](std::size_t k) {
                const float* p = &grid.positions[3 * grid.indices[t + k]];
                return Vec3f{p[0], p[1], p[2]};
            };
            expected += length(cross(at(1) - at(0), at(2) - at(0)));
        }
        CHECK(area == doctest::Approx(expected).epsilon(1e-6));

        // Cut short, or claiming more than it holds: an error.
        for (std::size_t keep = 0; keep < packed.size(); keep += 7) {
            GltfSample cut = sample;
            cut.json.erase("buffers");
            cut.json["bufferViews"][std::size_t(view)]["byteLength"] = keep;
            CHECK(contains(error_of(cut.load()), "Draco"));
        }
    }
}

TEST_CASE("gltf: meshopt gives the numbers that were packed, through its filters") {
    const Grid grid(16);
    const std::size_t vertices = grid.positions.size() / 3;
    std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(vertices, 12));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), grid.positions.data(), vertices, 12));
    std::vector<std::uint8_t> triangles(meshopt_encodeIndexBufferBound(grid.indices.size(), vertices));
    triangles.resize(
        meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), grid.indices.data(), grid.indices.size()));
    std::vector<float> up;
    for (std::size_t i = 0; i < vertices; ++i) up.insert(up.end(), {0.6f, 0, 0.8f, 0});
    std::vector<std::uint8_t> octahedral(4 * vertices), normals(meshopt_encodeVertexBufferBound(vertices, 4));
    meshopt_encodeFilterOct(octahedral.data(), vertices, 4, 8, up.data());
    normals.resize(meshopt_encodeVertexBuffer(normals.data(), normals.size(), octahedral.data(), vertices, 4));

    GltfSample sample;
    const auto view = [&](const std::vector<std::uint8_t>& bytes, const char* mode, int stride, std::size_t count,
                          const char* filter) {
        const int real = sample.view(bytes);
        const Json from = sample.json["bufferViews"][std::size_t(real)];
        // The buffer view lies in a fallback buffer, which holds nothing.
        sample.json["bufferViews"][std::size_t(real)] = {{"buffer", 1},
                                                         {"byteLength", count * std::size_t(stride)},
                                                         {"extensions",
                                                          {{"EXT_meshopt_compression",
                                                            {{"buffer", 0},
                                                             {"byteOffset", from["byteOffset"]},
                                                             {"byteLength", from["byteLength"]},
                                                             {"byteStride", stride},
                                                             {"count", count},
                                                             {"mode", mode},
                                                             {"filter", filter}}}}}};
        return real;
    };
    const int p = view(packed, "ATTRIBUTES", 12, vertices, "NONE"),
              i = view(triangles, "TRIANGLES", 4, grid.indices.size(), "NONE");
    const int n = view(normals, "ATTRIBUTES", 4, vertices, "OCTAHEDRAL");
    sample.json["bufferViews"][std::size_t(n)]["byteStride"] = 4;
    sample.add("accessors", {{"bufferView", p}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}});
    sample.add("accessors",
               {{"bufferView", i}, {"componentType", 5125}, {"count", grid.indices.size()}, {"type", "SCALAR"}});
    sample.add(
        "accessors",
        {{"bufferView", n}, {"componentType", 5120}, {"count", vertices}, {"type", "VEC3"}, {"normalized", true}});
    sample.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    sample.show({{"attributes", {{"POSITION", 0}, {"NORMAL", 2}}}, {"indices", 1}});
    sample.text();
    sample.json["buffers"].push_back(
        {{"byteLength", 100000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    const Mesh& mesh = scene->meshes[0];
    CHECK(scene->triangle_count() == 512);
    REQUIRE(mesh.positions.size() == vertices);
    std::size_t same = 0, upright = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        same += mesh.positions[v] == Vec3f{grid.positions[3 * v], grid.positions[3 * v + 1], grid.positions[3 * v + 2]};
        upright += near(mesh.normals[v], {0.6f, 0, 0.8f}, 0.01f);  // eight bits
    }
    CHECK(same == vertices);
    CHECK(upright == vertices);
    // A header that promises more than the bytes can hold is refused before memory is taken for it.
    for (const std::size_t many : {std::size_t(1) << 24, std::size_t(1) << 40}) {
        GltfSample bomb = sample;
        bomb.json["bufferViews"][std::size_t(p)]["extensions"]["EXT_meshopt_compression"]["count"] = many;
        CHECK(contains(error_of(bomb.load()), "cannot hold"));
    }
    GltfSample broken = sample;
    broken.json["bufferViews"][std::size_t(p)]["extensions"]["EXT_meshopt_compression"]["byteOffset"] = 8;
    CHECK(contains(error_of(broken.load()), "meshopt"));
}

TEST_CASE("gltf: files beside it are read, and no others") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "in/deeper");
    const auto write = [&](const std::string& name) {
        const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
        std::ofstream(folder / name, std::ios::binary).write(reinterpret_cast<const char*>(positions.data()), 36);
    };
    write("outside.bin"), write("in/a b.bin"), write("in/deeper/b.bin");
    std::filesystem::create_symlink(folder / "outside.bin", folder / "in/link.bin");
    const auto load = [&](const std::string& uri) {
        GltfSample sample;
        sample.show(sample.triangle());
        sample.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", uri}}});
        std::ofstream(folder / "in/s.gltf") << sample.json.dump();
        return error_of(load_scene(folder / "in/s.gltf"));
    };
    CHECK(load("a%20b.bin") == "loaded");
    CHECK(load("deeper/b.bin") == "loaded");
    CHECK(load("./deeper/../deeper/b.bin") == "loaded");
    CHECK(contains(load("../outside.bin"), "leaves the folder"));
    CHECK(contains(load("deeper/../../outside.bin"), "leaves the folder"));
    CHECK(contains(load("%2e%2e/outside.bin"), "leaves the folder"));
    CHECK(contains(load("link.bin"), "leaves the folder"));
    CHECK(contains(load((folder / "outside.bin").string()), "not the name of a file"));
    CHECK(contains(load("file:///etc/passwd"), "not the name of a file"));
    CHECK(contains(load("https://example.org/a.bin"), "not the name of a file"));
    CHECK(contains(load("missing.bin"), "no such file"));
    CHECK(contains(load("missing.bin"), "s.gltf"));
    CHECK(contains(load("deeper"), "buffers[0]"));
}

TEST_CASE("gltf: broken vertices, flat triangles and lost normals are mended, and said so") {
    GltfSample sample;
    const float nan = std::nanf(""), huge = 3e38f;
    const int positions =
        sample.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0, huge, 0, 0, 2, 0, 0}, "VEC3");
    const int normals =
        sample.accessor(std::vector<float>{0, 0, 0, nan, 0, 0, 0, 0, -7, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int indices =
        sample.accessor(std::vector<std::uint32_t>{0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 0, 1, 0, 1, 5}, "SCALAR");
    sample.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}});
    const auto scene = sample.load();
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(scene->triangle_count() == 1);
    CHECK(scene->bounds().high == Vec3f{2, 1, 0});
    const Mesh& mesh = scene->meshes[0];
    CHECK(mesh.normals[0] == Vec3f{0, 0, 1});  // recomputed
    CHECK(mesh.normals[1] == Vec3f{0, 0, 1});
    CHECK(mesh.normals[2] == Vec3f{0, 0, -1});  // only scaled
    CHECK(warns(*scene, "2 triangles left out: a vertex is not finite"));
    CHECK(warns(*scene, "2 triangles left out: they have no area"));
    CHECK(warns(*scene, "2 normals of no length"));
}

TEST_CASE("gltf: every real model loads") {
    const auto folder = data_folder();
    if (!folder || !std::filesystem::exists(*folder / "models")) return note_skip("DOMELIGHT_DATA has no models");
    struct Expected {
        const char* file;
        std::int64_t triangles;
        std::size_t materials, images;
    };
    constexpr Expected k_models[] = {
        {"models/AnisotropyStrengthTest.glb", 97240, 50, 1},
        {"models/ClearCoatTest.glb", 37116, 19, 6},
        {"models/CornellBox.glb", 36, 5, 0},
        {"models/GlamVelvetSofa.glb", 4196, 7, 2},
        {"models/SpecularTest.glb", 44828, 24, 4},
        {"models/FlightHelmet/FlightHelmet.gltf", 94722, 6, 15},
        {"bench/knot_l.glb", 100002, 2, 0},
        {"models/teapot.obj", 25200, 1, 0},
        {"models/plastic_monobloc_chair_01/plastic_monobloc_chair_01_1k.gltf", 3356, 1, 3}};
    for (const Expected& model : k_models) {
        INFO(model.file);
        const auto scene = load_scene(*folder / model.file);
        REQUIRE_MESSAGE(scene, error_of(scene));
        CHECK(scene->triangle_count() == model.triangles);
        CHECK(scene->materials.size() == model.materials);
        CHECK(scene->images.size() == model.images);
        const Scene::Box box = scene->bounds();
        CHECK(length(box.high - box.low) < 2000);
        for (const Mesh& mesh : scene->meshes) {
            // Shading normals point to the same side as the triangles they belong to.
            std::size_t against = 0;
            for (std::size_t t = 0; t < mesh.indices.size() && !mesh.normals.empty(); t += 3) {
                const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                            c = mesh.positions[mesh.indices[t + 2]];
                against += dot(cross(b - a, c - a), mesh.normals[mesh.indices[t]] + mesh.normals[mesh.indices[t + 1]] +
                                                        mesh.normals[mesh.indices[t + 2]]) < 0;
            }
            CHECK(against * 50 <= mesh.indices.size() / 3);  // in real models a few triangles differ: 2 %
        }
    }
}
