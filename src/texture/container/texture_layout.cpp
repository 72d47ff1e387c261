#include "texture/container/texture_layout.h"

#include "domelight/io/file/atomic_file.h"

#include "io/file/output_file.h"

namespace domelight {

std::vector<std::uint64_t> level_bytes_of(const Texture& texture) {
    std::vector<std::uint64_t> bytes;
    for (const TexelBytes& level : texture.levels) bytes.push_back(level.size());
    return bytes;
}

namespace {

/// Calls put(bytes) for all bytes of the file, from the front to the back.
template <typename Put>
void for_each_piece(const TextureLayout& layout, int faces, std::span<const TexelBytes> levels, const Put& put) {
    std::size_t frame = 0;
    const auto put_frame_before = [&](std::uint64_t offset) {
        for (; frame < layout.frame.size() && layout.frame[frame].offset < offset; ++frame)
            put(std::span<const std::uint8_t>(layout.frame[frame].bytes));
    };
    for (const TextureLayout::Block& block : layout.blocks) {
        put_frame_before(block.offset);
        const std::span<const std::uint8_t> level = levels[block.level];
        const std::size_t face_bytes = level.size() / std::size_t(faces);
        // A compressed level is one block, not a sequence of faces.
        put(block.faces == faces
                ? level
                : level.subspan(face_bytes * std::size_t(block.first_face), face_bytes * std::size_t(block.faces)));
    }
    put_frame_before(layout.size);
}

}  // namespace

Result<void> write_with_layout(const std::filesystem::path& file, const TextureLayout& layout, int faces,
                               std::span<const TexelBytes> levels) {
    return write_file_atomically(file, [&](const std::filesystem::path& path) {
        OutputFile out(path);
        for_each_piece(layout, faces, levels, [&](std::span<const std::uint8_t> bytes) { out.write(bytes); });
        return out.finish();
    });
}

TexelBytes bytes_with_layout(const TextureLayout& layout, int faces, std::span<const TexelBytes> levels) {
    TexelBytes file;
    file.reserve(std::size_t(layout.size));
    for_each_piece(layout, faces, levels,
                   [&](std::span<const std::uint8_t> bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); });
    return file;
}

}  // namespace domelight
