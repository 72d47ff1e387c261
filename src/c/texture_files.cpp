// Textures as the files of KTX2, KTX, DDS and Babylon.js, written or in memory.
#include "domelight/base/names.h"
#include "domelight/engines/engine.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/texture/container/texture_bytes.h"

#include "c/texture.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

using namespace domelight;

struct domelight_bytes {
    TexelBytes bytes;
};

namespace {

constexpr std::array k_formats{Container::ktx2, Container::ktx1, Container::dds, Container::dds9, Container::env};

struct FileRequest {
    Container container;
    Supercompression compression;
};

/// The container that a word names, or that a file's ending does where there is no word.
Result<FileRequest> read_request(const char* format, const char* file, const char* supercompression) {
    std::vector<std::string> accepted;
    for (const Container container : k_formats) accepted.push_back(name_of(container));
    const std::string word = format ? format : "";
    auto container = Container::ktx2;
    if (format) {
        const auto found = std::ranges::find(accepted, word);
        if (found == accepted.end()) return unknown_name(word, "a format", accepted).at(field_place("format"));
        container = k_formats[std::size_t(found - accepted.begin())];
    } else if (file) {
        const std::string ending = lower_case_extension(file);
        const auto found =
            std::ranges::find_if(k_formats, [&](Container c) { return container_extension(c) == ending; });
        if (found == k_formats.end())
            return Error{"does not end in .ktx2, .ktx, .dds or .env", file, "Say the format, or use one of these."};
        container = *found;
    }
    const std::string packing = c::text_or(supercompression, "none");
    if (packing != "none" && packing != "zstd") {
        const std::vector<std::string> known{"none", "zstd"};
        return unknown_name(packing, "a supercompression", known).at(field_place("supercompression"));
    }
    if (packing == "zstd" && container != Container::ktx2)
        return Error{name_of(container) + " has no supercompression", field_place("supercompression"), "Use ktx2."};
    return FileRequest{container, packing == "zstd" ? Supercompression::zstd : Supercompression::none};
}

/// The cube in Babylon's world, where glTF's direction (x, y, z) is (-x, y, z): +X and -X change places, and every face is
/// mirrored. Texels of four bytes.
Texture in_babylon_world(Texture cube) {
    for (int l = 0; l < int(cube.levels.size()); ++l) {
        auto* texels = reinterpret_cast<std::array<std::uint8_t, 4>*>(cube.levels[l].data());
        const std::size_t width = std::size_t(cube.level_width(l)), face = width * width;
        std::swap_ranges(texels, texels + face, texels + face);
        for (std::size_t row = 0; row < 6 * width; ++row)
            std::reverse(texels + row * width, texels + (row + 1) * width);
    }
    return cube;
}

Result<TexelBytes> env_of(const domelight_texture& texture) {
    BabylonEnv env;
    env.cube = texture.texture;
    if (env.cube.encoding == Encoding::rgbd && env.cube.faces == 6) env.cube = in_babylon_world(std::move(env.cube));
    if (texture.sh.size() >= 9) env.irradiance = babylon_polynomial(texture.sh);
    return env_bytes(env);
}

Result<TexelBytes> bytes_of(const domelight_texture& texture, const FileRequest& request) {
    switch (request.container) {
        case Container::ktx1:
            return ktx1_bytes(texture.texture);
        case Container::dds:
            return dds_bytes(texture.texture);
        case Container::dds9:
            return dds9_bytes(texture.texture);
        case Container::env:
            return env_of(texture);
        default:
            return ktx2_bytes(texture.texture, request.compression);
    }
}

}  // namespace

extern "C" {

domelight_error* domelight_texture_write(const domelight_texture* texture, const char* file, const char* format,
                                         const char* supercompression) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {file, "file"}}); !ok) return ok;
        const auto request = read_request(format, file, supercompression);
        if (!request) return request.error();
        const auto bytes = bytes_of(*texture, *request);
        if (!bytes) return bytes.error().at(file);
        return write_file_atomically(file, *bytes);
    });
}

domelight_error* domelight_texture_file(const domelight_texture* texture, const char* format,
                                        const char* supercompression, domelight_bytes** bytes) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{texture, "texture"}, {bytes, "bytes"}}); !ok) return ok;
        const auto request = read_request(format, nullptr, supercompression);
        if (!request) return request.error();
        auto file = bytes_of(*texture, *request);
        if (!file) return file.error();
        return c::hand_out(bytes, *std::move(file));
    });
}

const void* domelight_bytes_data(const domelight_bytes* bytes, size_t* size) {
    if (size) *size = bytes ? bytes->bytes.size() : 0;
    return bytes ? bytes->bytes.data() : nullptr;
}

void domelight_bytes_free(domelight_bytes* bytes) {
    delete bytes;
}

}  // extern "C"
