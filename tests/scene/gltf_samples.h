#pragma once
// Tiny glTF files to read.

#include "domelight/scene/scene.h"

#include "test.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace domelight::test {

using Json = nlohmann::json;

template <typename T>
std::vector<std::uint8_t> bytes_of(const std::vector<T>& values) {
    std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? alphabet[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// A document under construction, with one buffer.
struct GltfSample {
    Json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::uint8_t> data;

    int add(const char* array, Json element) {
        json[array].push_back(std::move(element));
        return int(json[array].size()) - 1;
    }
    int view(const std::vector<std::uint8_t>& bytes, int stride = 0) {
        while (data.size() % 4) data.push_back(0);
        Json view = {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}};
        if (stride) view["byteStride"] = stride;
        data.insert(data.end(), bytes.begin(), bytes.end());
        return add("bufferViews", std::move(view));
    }
    /// Numbers of an accessor of its own view.
    template <typename T>
    int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
        const int code = std::is_same_v<T, float>           ? 5126
                         : std::is_same_v<T, std::uint32_t> ? 5125
                         : std::is_same_v<T, std::uint16_t> ? 5123
                         : std::is_same_v<T, std::int16_t>  ? 5122
                         : std::is_same_v<T, std::uint8_t>  ? 5121
                                                            : 5120;
        const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type[3] - '0');
        Json a = {{"bufferView", view(bytes_of(values))},
                  {"componentType", code},
                  {"count", values.size() / components},
                  {"type", type}};
        if (normalized) a["normalized"] = true;
        return add("accessors", std::move(a));
    }
    /// One triangle (0,0,0) (1,0,0) (0,1,0) as primitive.
    Json triangle() {
        const int positions = accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        return {{"attributes", {{"POSITION", positions}}}};
    }
    /// A mesh of one primitive, and a node for it.
    int show(Json primitive, Json node = Json::object()) {
        node["mesh"] = add("meshes", {{"primitives", Json::array({std::move(primitive)})}});
        return add("nodes", std::move(node));
    }
    std::string text() {
        if (!data.empty() && !json.contains("buffers"))
            json["buffers"] = Json::array(
                {{{"byteLength", data.size()}, {"uri", "data:application/octet-stream;base64," + base64(data)}}});
        return json.dump();
    }
    Result<Scene> load(const SceneOptions& options = {}) {
        const TemporaryFolder folder;
        std::ofstream(folder / "sample.gltf") << text();
        return load_scene(folder / "sample.gltf", options);
    }
};

/// Loads text as a file of that name.
inline Result<Scene> load_text(const std::string& text, const std::string& name) {
    const TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    return load_scene(folder / name);
}

/// The message of a scene that must not load; "loaded" if it did.
inline std::string error_of(const Result<Scene>& scene) {
    return scene ? "loaded" : scene.error().format();
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}
inline bool warns(const Scene& scene, const std::string& part) {
    for (const std::string& line : scene.warnings)
        if (contains(line, part)) return true;
    return false;
}

inline bool near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-6f) {
    return length(a - b) <= tolerance;
}

}  // namespace domelight::test
