#include "scene/gltf/gltf_chunks.h"

#include "io/file/byte_source.h"

#include <fmt/format.h>

namespace domelight {

Result<GltfChunks> split_gltf(std::span<const std::uint8_t> bytes) {
    const auto text = [](std::span<const std::uint8_t> b) {
        return std::string_view(reinterpret_cast<const char*>(b.data()), b.size());
    };
    if (bytes.size() < 4 || text(bytes.first(4)) != "glTF") return GltfChunks{text(bytes), {}};
    if (bytes.size() < 20) return Error{"file ends too early: a .glb has a header of 20 bytes", "", ""};
    if (const std::uint32_t version = u32_at(bytes, 4); version != 2)
        return Error{fmt::format("version {}, but only glTF 2.0 is read", version), "", ""};
    const std::uint64_t length = u32_at(bytes, 8);
    if (length > bytes.size() || length < 20)
        return Error{fmt::format("file ends too early: {} bytes, but its header says {}", bytes.size(), length), "",
                     "The file is truncated."};
    GltfChunks chunks;
    for (std::uint64_t at = 12; at + 8 <= length;) {
        const std::uint64_t size = u32_at(bytes, at);
        const std::uint32_t type = u32_at(bytes, at + 4);
        if (size > length - at - 8)
            return Error{fmt::format("a chunk of {} bytes does not fit into the file", size), "",
                         "The file is truncated."};
        const auto chunk = bytes.subspan(at + 8, size);
        if (at == 12 && type != 0x4e4f534a) return Error{"its first chunk is not JSON", "", ""};
        if (at == 12)
            chunks.json = text(chunk);
        else if (type == 0x004e4942 && chunks.binary.empty())
            chunks.binary = chunk;
        at += 8 + (size + 3) / 4 * 4;
    }
    return chunks;
}

}  // namespace domelight
