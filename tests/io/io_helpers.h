#pragma once
// Files as bytes, and textures to write.

#include "domelight/texture/texture.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace domelight::test {

inline std::vector<std::uint8_t> file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

inline constexpr Encoding k_encodings[] = {Encoding::rgba16f, Encoding::rgba32f, Encoding::rgb9e5, Encoding::r11g11b10f,
                                           Encoding::rg16f,   Encoding::rg32f,   Encoding::bc6h};
/// The encodings whose meaning is stated by a key, which DDS does not have.
inline constexpr Encoding k_scaled_bytes[] = {Encoding::rgbm, Encoding::rgbd, Encoding::rgbp};

/// A texture of distinct bytes with some metadata.
inline Texture sample_texture(Encoding encoding, int size, int faces, int levels) {
    Texture texture;
    texture.encoding = encoding;
    texture.width = size;
    texture.height = faces == 6 ? size : std::max(1, size / 2);
    texture.faces = faces;
    std::uint32_t state = 1;
    for (int l = 0; l < levels; ++l) {
        auto& level = texture.levels.emplace_back(texture.face_bytes(l) * std::size_t(faces));
        for (auto& byte : level) byte = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
    }
    texture.metadata = {{"domelight.roughness", "0 0.5 1"}, {"a", ""}, {"name", "H\xc3\xa4user"}};
    return texture;
}

inline bool same_texels(const Texture& a, const Texture& b) {
    return a.encoding == b.encoding && a.width == b.width && a.height == b.height && a.faces == b.faces &&
           a.levels == b.levels;
}

}  // namespace domelight::test
