#include "texture/container/cube_array.h"

#include "texture/container/ktx2.h"
#include "texture/container/texture_layout.h"
#include "texture/container/texture_reading.h"
#include "texture/container/vulkan_formats.h"

#include <fmt/core.h>

#include <cassert>
#include <cstring>

namespace domelight {
namespace {

/// A cube without texels.
Texture head_of(const CubeArrayShape& shape) {
    Texture head;
    head.encoding = shape.encoding;
    head.width = head.height = shape.size;
    head.faces = 6;
    head.metadata = shape.metadata;
    return head;
}

/// The shape that a header states, with the positions of the levels.
struct StatedArray {
    CubeArrayShape shape;
    std::vector<std::uint64_t> offsets;
};

Result<StatedArray> stated_array(ByteSource& source) {
    const auto info = ktx2_info(source);
    if (!info) return info.error();
    if (info->faces != 6) return Error{fmt::format("holds no cubes but {} face", info->faces), "", ""};
    const auto head = source.take(0, k_ktx2_header_bytes + k_ktx2_level_bytes * std::uint64_t(info->levels), "header");
    if (!head) return head.error();
    const auto texels = vulkan_format_texels(u32_at(*head, 12));
    if (!texels || texels->channels > 0 || texels->screen || encoding_block(texels->encoding) > 1 ||
        info->supercompression != "none")
        return Error{
            fmt::format("holds {}, supercompression {}", info->format, info->supercompression), "",
            "Sets of probes have texels of RGB9E5, RGBA16F, RGBA32F, RG16F or RG32F without supercompression."};
    StatedArray stated{{texels->encoding, info->width, info->levels, std::max(1, info->layers), info->metadata}, {}};
    for (int l = 0; l < info->levels; ++l) {
        const std::size_t at = std::size_t(k_ktx2_header_bytes + k_ktx2_level_bytes * std::uint64_t(l));
        const std::uint64_t bytes = u64_at(*head, at + 8), needed = stated.shape.cube_bytes(l);
        if (bytes / needed != std::uint64_t(stated.shape.cubes) || bytes % needed != 0)
            return Error{
                fmt::format("level {} has {} bytes, but {} cubes need {} each", l, bytes, stated.shape.cubes, needed),
                "", "the file is damaged"};
        stated.offsets.push_back(u64_at(*head, at));
    }
    return stated;
}

}  // namespace

Result<CubeArrayWriter> CubeArrayWriter::open(const std::filesystem::path& path, const CubeArrayShape& shape) {
    assert(encoding_block(shape.encoding) == 1);
    std::vector<std::uint64_t> bytes;
    for (int l = 0; l < shape.levels; ++l) bytes.push_back(shape.cube_bytes(l) * std::uint64_t(shape.cubes));
    const auto layout = ktx2_layout(head_of(shape), bytes, Supercompression::none, bytes, {.layers = shape.cubes});
    if (!layout) return layout.error();
    auto file = std::make_unique<OutputFile>(path);
    for (const auto& frame : layout->frame) file->write_at(frame.offset, frame.bytes);
    std::vector<std::uint64_t> offsets(bytes.size());
    for (const auto& block : layout->blocks) offsets[std::size_t(block.level)] = block.offset;
    if (file->failed()) return file->finish().error().at(path.string());
    return CubeArrayWriter(shape, std::move(offsets), std::move(file));
}

void CubeArrayWriter::write(int cube, int level, std::span<const std::uint8_t> texels) {
    assert(texels.size() == shape_.cube_bytes(level));
    file_->write_at(offsets_[std::size_t(level)] + shape_.cube_bytes(level) * std::uint64_t(cube), texels);
}

Result<void> CubeArrayWriter::finish() {
    return file_->finish();
}

Result<CubeArrayReader> CubeArrayReader::open(const std::filesystem::path& path) {
    auto file = FileSource::open(path);
    if (!file) return file.error();
    auto stated = stated_array(*file);
    if (!stated) return stated.error().at(path.string());
    return CubeArrayReader(std::move(stated->shape), std::move(stated->offsets), *std::move(file));
}

Result<Bytes> CubeArrayReader::read(int cube, int level) {
    const std::uint64_t bytes = shape_.cube_bytes(level);
    return file_.take(offsets_[std::size_t(level)] + bytes * std::uint64_t(cube), bytes, "cube");
}

Result<Cubemap> CubeArrayReader::decode(int cube, int level) {
    auto bytes = read(cube, level);
    if (!bytes) return bytes.error();
    Texture texture = head_of(shape_);
    texture.metadata.clear();
    texture.width = texture.height = shape_.level_size(level);
    texture.levels.push_back(*std::move(bytes));
    const int size = texture.width, channels = encoding_channels(shape_.encoding);
    Cubemap out(size, channels);
    for (int f = 0; f < 6; ++f) {
        const ImageF face = decode_texture(texture, 0, f);
        std::ranges::copy(face.pixels(), out.face(f).data);
    }
    return out;
}

}  // namespace domelight
