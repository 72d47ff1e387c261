#include "gltf_samples.h"

#include <algorithm>

using namespace domelight;
using namespace domelight::test;

namespace {

const char* const k_properties =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\n"
    "element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";

void put(std::string& out, const void* value, std::size_t size, bool big) {
    std::string bytes(static_cast<const char*>(value), size);
    if (big) std::reverse(bytes.begin(), bytes.end());
    out += bytes;
}

/// A quad and a triangle.
std::string binary(bool big) {
    std::string out =
        std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") + " 1.0\n" + k_properties;
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (const auto& corner : corners) {
        for (const float c : corner) put(out, &c, 4, big);
        out += std::string("\xff\x00\x80", 3);
    }
    for (const std::vector<std::int32_t>& face : {std::vector<std::int32_t>{0, 1, 2, 3}, {0, 1, 2}}) {
        out += '\7';
        out += char(face.size());
        for (const std::int32_t i : face) put(out, &i, 4, big);
    }
    return out;
}

}  // namespace

TEST_CASE("ply: ascii and binary of both byte orders are the same scene") {
    const std::string text =
        std::string("ply\r\nformat ascii 1.0\ncomment made by hand\n") + k_properties +
        "0 0 0 255 0 128\n1 0 0 255 0 128\n1 1 0 255 0 128\n0 1 0 255 0 128\n7 4 0 1 2 3\n7 3 0 1 2";
    for (const std::string& file : {text, binary(false), binary(true)}) {
        const auto scene = load_text(file, "a.ply");
        REQUIRE_MESSAGE(scene, error_of(scene));
        const Mesh& mesh = scene->meshes[0];
        CHECK(mesh.indices == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2});
        CHECK(mesh.positions[2] == Vec3f{1, 1, 0});
        CHECK(mesh.normals.empty());
        REQUIRE(mesh.colors.size() == 4);
        CHECK(near(mesh.colors[0].rgb, {1, 0, 0.2158605f}));  // 128 of sRGB is linear
    }
}

TEST_CASE("ply: normals, texture coordinates and other elements") {
    const auto scene = load_text(
        "ply\nformat ascii 1.0\nelement material 1\nproperty int kind\nelement vertex 3\nproperty double x\nproperty "
        "double y\nproperty double z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 1\n"
        "property list uint8 uint vertex_index\nend_header\n5\n0 0 0 0 0 2 0 0\n1 0 0 0 0 2 1 0\n0 1 0 0 0 2 0 1\n3 0 "
        "1 2\n",
        "a.ply");
    REQUIRE_MESSAGE(scene, error_of(scene));
    CHECK(scene->meshes[0].normals == std::vector<Vec3f>(3, {0, 0, 1}));
    CHECK(scene->meshes[0].texcoords[0][2].v == 0);
    CHECK(scene->meshes[0].texcoords[0][0].v == 1);
    CHECK(warns(*scene, "'material' left out"));
}

TEST_CASE("ply: truncated and lying files are errors") {
    const std::string whole = binary(false);
    for (std::size_t keep = 0; keep < whole.size(); ++keep) CHECK(!load_text(whole.substr(0, keep), "a.ply"));
    const auto changed = [&](std::string from, std::string to) {
        std::string file = whole;
        file.replace(file.find(from), from.size(), to);
        return error_of(load_text(file, "a.ply"));
    };
    CHECK(contains(changed("vertex 4", "vertex 4000000000"), "do not fit"));
    CHECK(contains(changed("vertex 4", "vertex 18446744073709551615"), "do not fit"));
    CHECK(contains(changed("vertex 4", "vertex -1"), "is not a number of elements"));
    CHECK(contains(changed("float x", "complex x"), "property of type"));
    CHECK(contains(changed("float x", "float w"), "no x, y and z"));
    CHECK(contains(changed("list uchar", "list float"), "no whole type"));
    CHECK(contains(changed("binary_little_endian", "binary_middle_endian"), "there is no format"));
    CHECK(contains(changed(std::string("\4\0\0\0\0\1", 6), std::string("\4\0\0\0\0\x09", 6)), "there is no vertex 9"));
    CHECK(
        contains(changed("element face 2\n", "element face 2\nelement nothing 18446744073709551615\n"), "do not fit"));
    // Entries of no bytes: reading them would take for ever.
    for (const char* name : {"nothing", "face", "vertex"})
        CHECK(contains(changed("end_header", std::string("element ") + name + " 18446744073709551615\nend_header"),
                       "do not fit"));
    CHECK(changed("end_header", "element nothing 0\nend_header") == "loaded");
    CHECK(contains(error_of(load_text("not a ply", "a.ply")), "not a PLY file"));
}
