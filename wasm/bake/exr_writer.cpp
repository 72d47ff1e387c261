// OpenEXR images, byte for byte as io/exr/exr_writer.cpp and exr_levels_writer.cpp have OpenEXR 3.1 write them, with the compressions "zip" and "none" ("The OpenEXR
// File Layout"; ImfZip.cpp for what precedes the deflating).

#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "deflate.h"
#include "io/exr/exr_levels.h"
#include "io/file/byte_buffer.h"
#include "texture/texel/half.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <vector>

namespace domelight {

namespace {

constexpr int k_chunk_rows = 16;
/// OpenEXR's own choice for its tools.
constexpr int k_tile = 64;
/// OpenEXR's default level of deflate.
constexpr int k_zip_level = 4;

void add_float(ByteBuffer& out, float value) {
    out.u32(std::bit_cast<std::uint32_t>(value));
}

struct Attribute {
    std::string type;
    std::vector<std::uint8_t> value;
};

/// What the chunks of a file are made from.
struct ExrForm {
    int width, height, channels;
    bool half, packed;
    bool tiled = false;
    std::size_t sample() const { return half ? 2 : 4; }
};

/// A channel's place in a pixel, in the order in which files hold them: A B G R, or Y.
std::vector<std::pair<const char*, int>> sorted_channels(int channels) {
    if (channels == 1) return {{"Y", 0}};
    std::vector<std::pair<const char*, int>> sorted{{"A", 3}, {"B", 2}, {"G", 1}, {"R", 0}};
    std::erase_if(sorted, [&](const auto& channel) { return channel.second >= channels; });
    return sorted;
}

ByteBuffer channel_list(const ExrForm& form) {
    ByteBuffer out;
    for (const auto& [name, place] : sorted_channels(form.channels)) {
        out.text(name);
        out.u8(0);
        out.u32(form.half ? 1 : 2);
        out.u32(0);  // not perceptually linear
        out.u32(1);  // every column and row
        out.u32(1);
    }
    out.u8(0);
    return out;
}

/// The header, by the names of its attributes.
std::map<std::string, Attribute> attributes_of(const ExrForm& form, const ExrWriteOptions& options) {
    std::map<std::string, Attribute> all;
    const auto add = [&](const char* name, const char* type, const auto& fill) {
        ByteBuffer value;
        fill(value);
        all[name] = {type, value.take()};
    };
    const auto window = [&](ByteBuffer& v) {
        v.u64(0);
        v.u32(std::uint32_t(form.width - 1));
        v.u32(std::uint32_t(form.height - 1));
    };
    add("channels", "chlist", [&](ByteBuffer& v) { v.append(channel_list(form).bytes()); });
    add("chromaticities", "chromaticities", [](ByteBuffer& v) {
        for (const float number : {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}) add_float(v, number);
    });
    add("compression", "compression", [&](ByteBuffer& v) { v.u8(form.packed ? 3 : 0); });
    add("dataWindow", "box2i", window);
    add("displayWindow", "box2i", window);
    if (!options.envmap.empty()) add("envmap", "envmap", [&](ByteBuffer& v) { v.u8(options.envmap == "cube"); });
    add("lineOrder", "lineOrder", [](ByteBuffer& v) { v.u8(0); });
    add("pixelAspectRatio", "float", [](ByteBuffer& v) { add_float(v, 1); });
    add("screenWindowCenter", "v2f", [](ByteBuffer& v) { v.u64(0); });
    add("screenWindowWidth", "float", [](ByteBuffer& v) { add_float(v, 1); });
    if (form.tiled)
        add("tiles", "tiledesc", [](ByteBuffer& v) {
            v.u32(k_tile);
            v.u32(k_tile);
            v.u8(1);  // levels of half the size each, rounded down
        });
    for (const auto& [name, value] : options.attributes) add(name.c_str(), "string", [&](ByteBuffer& v) { v.text(value); });
    return all;
}

ByteBuffer header_of(const ExrForm& form, const ExrWriteOptions& options) {
    const auto attributes = attributes_of(form, options);
    const bool long_names = std::any_of(attributes.begin(), attributes.end(), [](const auto& a) { return a.first.size() > 31 || a.second.type.size() > 31; });
    ByteBuffer out;
    out.u32(20000630);
    out.u32(2u | (form.tiled ? 0x200u : 0u) | (long_names ? 0x400u : 0u));
    for (const auto& [name, attribute] : attributes) {
        out.text(name);
        out.u8(0);
        out.text(attribute.type);
        out.u8(0);
        out.u32(std::uint32_t(attribute.value.size()));
        out.append(attribute.value);
    }
    out.u8(0);
    return out;
}

/// Part of an image: row by row, in each all of a channel.
std::vector<std::uint8_t> planes(ImageView<const float> part, const ExrForm& form) {
    ByteBuffer out;
    for (int y = 0; y < part.height; ++y)
        for (const auto& [name, place] : sorted_channels(form.channels))
            for (int x = 0; x < part.width; ++x) {
                const float v = part.row(y)[x * part.channels + place];
                if (form.half)
                    out.u16(half_from_float(v > k_half_max ? k_half_max : v < -k_half_max ? -k_half_max : v));
                else
                    add_float(out, v);
            }
    return out.take();
}

/// Even bytes before odd ones, and differences in place of values. As they are where that does not make them smaller.
std::vector<std::uint8_t> zipped(std::vector<std::uint8_t> raw) {
    std::vector<std::uint8_t> parted(raw.size());
    const std::size_t half = (raw.size() + 1) / 2;
    for (std::size_t i = 0; i < raw.size(); ++i) parted[i / 2 + (i % 2 ? half : 0)] = raw[i];
    for (std::size_t i = parted.size(); i-- > 1;) parted[i] = std::uint8_t(parted[i] - parted[i - 1] + 128);
    auto packed = deflated(parted, k_zip_level, Z_DEFAULT_STRATEGY);
    return packed.size() < raw.size() ? packed : raw;
}

std::vector<std::uint8_t> stored(ImageView<const float> part, const ExrForm& form) {
    auto raw = planes(part, form);
    return form.packed ? zipped(std::move(raw)) : raw;
}

/// Header, a table of where the chunks are, and the chunks.
std::vector<std::uint8_t> assembled(ByteBuffer head, const std::vector<ByteBuffer>& chunks) {
    std::uint64_t at = head.size() + 8 * chunks.size();
    for (const ByteBuffer& chunk : chunks) {
        head.u64(at);
        at += chunk.size();
    }
    std::vector<std::uint8_t> file;
    file.reserve(std::size_t(at));
    file.insert(file.end(), head.bytes().begin(), head.bytes().end());
    for (const ByteBuffer& chunk : chunks) file.insert(file.end(), chunk.bytes().begin(), chunk.bytes().end());
    return file;
}

/// An error for what this writer does not know.
Result<void> check(const ExrWriteOptions& options, int width, int height) {
    if (options.compression != "zip" && options.compression != "none")
        return Error{"\"" + options.compression + "\" is not a compression that the WebAssembly module writes", "", "Accepted: none, zip."};
    if (options.envmap == "cube" && height != 6 * width)
        return Error{"a cube must be a strip six times as high as wide", "", ""};
    return {};
}

void add_tiles(std::vector<ByteBuffer>& chunks, int level, const ImageF& image, const ExrForm& form) {
    for (int y = 0; y < image.height(); y += k_tile)
        for (int x = 0; x < image.width(); x += k_tile) {
            ImageView<const float> tile = image.view();
            tile.data += std::ptrdiff_t(y) * tile.stride + std::ptrdiff_t(x) * tile.channels;
            tile.width = std::min(k_tile, image.width() - x);
            tile.height = std::min(k_tile, image.height() - y);
            const auto bytes = stored(tile, form);
            ByteBuffer& chunk = chunks.emplace_back();
            for (const int number : {x / k_tile, y / k_tile, level, level, int(bytes.size())}) chunk.u32(std::uint32_t(number));
            chunk.append(bytes);
        }
}

}  // namespace

Result<void> write_exr(const std::filesystem::path& file, ImageView<const float> pixels, const ExrWriteOptions& options) {
    if (auto ok = check(options, pixels.width, pixels.height); !ok) return ok.error().at(file.string());
    ImageF cube;
    if (options.envmap == "cube") {
        cube = exr_cube_strip(pixels);
        pixels = cube;
    }
    const ExrForm form{pixels.width, pixels.height, pixels.channels, options.half.value_or(fits_half(pixels)), options.compression == "zip"};
    const int step = form.packed ? k_chunk_rows : 1;
    std::vector<ByteBuffer> chunks;
    for (int y = 0; y < pixels.height; y += step) {
        const auto bytes = stored(pixels.rows(y, std::min(step, pixels.height - y)), form);
        ByteBuffer& chunk = chunks.emplace_back();
        chunk.u32(std::uint32_t(y));
        chunk.u32(std::uint32_t(bytes.size()));
        chunk.append(bytes);
    }
    return write_file_atomically(file, std::span<const std::uint8_t>(assembled(header_of(form, options), chunks)));
}

Result<void> write_exr_levels(const std::filesystem::path& file, std::span<const ImageView<const float>> levels, const ExrWriteOptions& options) {
    if (levels.empty()) return Error{"no level to write", file.string(), ""};
    const bool cube = options.envmap == "cube";
    const int width = levels[0].width, height = levels[0].height;
    if (auto ok = check(options, width, height); !ok) return ok.error().at(file.string());
    if (auto ok = check_exr_level_sizes(levels, cube); !ok) return ok.error().at(file.string());
    const bool half = options.half.value_or(std::all_of(levels.begin(), levels.end(), [](const auto& level) { return fits_half(level); }));
    const ExrForm form{width, height, levels[0].channels, half, options.compression == "zip", true};
    std::vector<ByteBuffer> chunks;
    ImageF image;
    const int count = std::bit_width(unsigned(std::max(width, height)));
    for (int l = 0; l < count; ++l) {
        image = std::size_t(l) < levels.size() ? exr_level(levels[std::size_t(l)], cube) : next_exr_level(image);
        add_tiles(chunks, l, image, form);
    }
    return write_file_atomically(file, std::span<const std::uint8_t>(assembled(header_of(form, options), chunks)));
}

}  // namespace domelight
