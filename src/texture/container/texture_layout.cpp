#include "texture/container/texture_layout.h"

#include "domelight/io/file/atomic_file.h"

#include "io/file/output_file.h"

namespace domelight {

std::vector<std::uint64_t> level_bytes_of(const Texture& texture) {
    std::vector<std::uint64_t> bytes;
    for (const TexelBytes& level : texture.levels) bytes.push_back(level.size());
    return bytes;
}

Result<void> write_with_layout(const std::filesystem::path& file, const TextureLayout& layout, int faces,
                               std::span<const TexelBytes> levels) {
    return write_file_atomically(file, [&](const std::filesystem::path& path) {
        OutputFile out(path);
        std::size_t frame = 0;
        const auto write_frame_before = [&](std::uint64_t offset) {
            for (; frame < layout.frame.size() && layout.frame[frame].offset < offset; ++frame)
                out.write(layout.frame[frame].bytes);
        };
        for (const TextureLayout::Block& block : layout.blocks) {
            write_frame_before(block.offset);
            const std::span<const std::uint8_t> level = levels[block.level];
            const std::size_t face_bytes = level.size() / std::size_t(faces);
            // A compressed level is one block, not a sequence of faces.
            out.write(block.faces == faces ? level
                                           : level.subspan(face_bytes * std::size_t(block.first_face),
                                                           face_bytes * std::size_t(block.faces)));
        }
        write_frame_before(layout.size);
        return out.finish();
    });
}

}  // namespace domelight
