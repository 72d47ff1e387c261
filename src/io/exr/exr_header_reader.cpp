#include "io/exr/exr_header_reader.h"

#include "io/file/printable.h"
#include "io/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

namespace domelight {

namespace {

// "OpenEXR File Layout", section "Header": attributes of (name \0, type \0, int32 size, bytes), ended by an empty name.

/// Attributes that decoding needs; the others are masked. The library reads the value of a known type without checking
/// its size, so type and size must both be right, or the bytes that follow would be misread.
struct Needed {
    std::string_view name, type;
    int size;  ///< bytes, or k_any_size if any size is valid
};
constexpr int k_any_size = -1;
constexpr std::array<Needed, 17> k_needed{{
    {"channels", "chlist", k_any_size},
    {"compression", "compression", 1},
    {"dataWindow", "box2i", 16},
    {"displayWindow", "box2i", 16},
    {"lineOrder", "lineOrder", 1},
    {"pixelAspectRatio", "float", 4},
    {"screenWindowCenter", "v2f", 8},
    {"screenWindowWidth", "float", 4},
    {"tiles", "tiledesc", 9},
    {"type", "string", k_any_size},
    {"name", "string", k_any_size},
    {"view", "string", k_any_size},
    {"chunkCount", "int", 4},
    {"version", "int", 4},
    {"maxSamplesPerPixel", "int", 4},
    {"envmap", "envmap", 1},
    {"chromaticities", "chromaticities", 32},
}};

constexpr std::uint32_t k_multi_part = 0x1000;

/// Reads little-endian numbers and strings, and never beyond the end of the bytes.
class Cursor {
  public:
    explicit Cursor(std::span<const std::uint8_t> bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
    std::size_t at() const { return at_; }
    bool skip(std::size_t n) {
        if (n > bytes_.size() - at_) return false;
        at_ += n;
        return true;
    }
    std::optional<std::int32_t> int32() {
        if (bytes_.size() - at_ < 4) return std::nullopt;
        std::uint32_t v = 0;
        for (int i = 3; i >= 0; --i) v = v << 8 | bytes_[at_ + std::size_t(i)];
        at_ += 4;
        return std::bit_cast<std::int32_t>(v);
    }
    std::optional<std::uint8_t> byte() {
        if (at_ >= bytes_.size()) return std::nullopt;
        return bytes_[at_++];
    }
    /// A string of at most 255 bytes up to its zero.
    std::optional<std::string_view> text() {
        const std::size_t limit = std::min(bytes_.size(), at_ + 256);
        for (std::size_t end = at_; end < limit; ++end) {
            if (bytes_[end]) continue;
            const std::string_view result(reinterpret_cast<const char*>(bytes_.data()) + at_, end - at_);
            at_ = end + 1;
            return result;
        }
        return std::nullopt;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_;
};

/// What the size of the decoded blocks depends on.
struct PartShape {
    ExrWindow data_window{0, 0, -1, -1};
    std::int64_t tile_width = 0, tile_height = 0;
    int compression = -1;
    std::int64_t bytes_per_texel = 0;
    double stored_bytes_per_texel = 0;  ///< on average: subsampled channels have fewer texels
    int channels = 0;
};

Error damaged(std::string what) {
    return {std::move(what), "", "The file is truncated or damaged."};
}

/// Scanlines that are compressed together, by compression method (none rle zips zip piz pxr24 b44 b44a dwaa dwab).
int lines_per_block(int compression) {
    constexpr std::array<int, 10> lines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return compression >= 0 && compression < int(lines.size()) ? lines[std::size_t(compression)] : 1;
}

/// How many bytes at most one byte of a file becomes, by compression method; infinite where a block of any size may
/// take some bytes. RLE: 2 bytes for 128. Deflate: 1032 (zlib's documentation), of which PXR24 makes 4/3 as floats lose
/// a byte. B44: 14 bytes for 32, B44A: 3; both store what is not half as it is.
double most_expansion(int compression) {
    constexpr double k_any = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 10> most{1, 64, 1032, 1032, k_any, 1376, 32. / 14, 32. / 3, k_any, k_any};
    return compression >= 0 && compression < int(most.size()) ? most[std::size_t(compression)] : k_any;
}

Result<void> read_channels(std::span<const std::uint8_t> value, PartShape& shape) {
    const Error broken = damaged("the list of channels is broken");
    Cursor cursor(value);
    for (;;) {
        const auto name = cursor.text();
        if (!name) return broken;
        if (name->empty()) {
            if (cursor.at() != value.size()) return broken;
            return {};
        }
        const auto type = cursor.int32();
        if (!type || !cursor.skip(4)) return broken;
        const auto x_sampling = cursor.int32(), y_sampling = cursor.int32();
        if (!x_sampling || !y_sampling || *x_sampling < 1 || *y_sampling < 1 || *type < 0 || *type > 2) return broken;
        shape.bytes_per_texel += *type == 1 ? 2 : 4;
        shape.stored_bytes_per_texel += (*type == 1 ? 2 : 4) / (double(*x_sampling) * *y_sampling);
        if (++shape.channels > 1024) return Error{"image has more than 1024 channels", "", ""};
    }
}

/// Reads what concerns sizes from one attribute.
Result<void> read_attribute(std::string_view name, std::span<const std::uint8_t> value, PartShape& shape) {
    Cursor cursor(value);
    if (name == "channels") return read_channels(value, shape);
    if (name == "dataWindow") {
        for (std::int32_t& v : shape.data_window) v = cursor.int32().value_or(0);
    } else if (name == "compression") {
        shape.compression = cursor.byte().value_or(255);
    } else if (name == "tiles") {
        shape.tile_width = std::uint32_t(cursor.int32().value_or(0));
        shape.tile_height = std::uint32_t(cursor.int32().value_or(0));
        if (shape.tile_width < 1 || shape.tile_height < 1) return damaged("tiles have no texels");
    }
    return {};
}

Result<void> check_part(const PartShape& shape, std::size_t file_size, std::int64_t max_bytes) {
    const std::int64_t width = std::int64_t(shape.data_window[2]) - shape.data_window[0] + 1;
    const std::int64_t height = std::int64_t(shape.data_window[3]) - shape.data_window[1] + 1;
    if (const auto sized = check_image_size(width, height); !sized) return sized.error();
    if (shape.channels == 0) return damaged("image has no channels");
    const bool tiled = shape.tile_width > 0;
    const std::int64_t block_width = tiled ? shape.tile_width : width;
    const std::int64_t block_height = tiled ? shape.tile_height : lines_per_block(shape.compression);
    if (block_width > k_max_image_side || block_height > k_max_image_side)
        return damaged(fmt::format("tiles are {} x {}", block_width, block_height));
    const std::int64_t chunks =
        ((width + block_width - 1) / block_width) * ((height + block_height - 1) / block_height);
    // Every chunk has an entry of 8 bytes in the table of offsets and starts with at least 8 bytes of its own.
    if (chunks > std::int64_t(file_size / 16))
        return damaged(
            fmt::format("file ends too early: {} bytes cannot hold {} x {} texels", file_size, width, height));
    // Tiles at the rim are whole in memory and cut in the file, so only the texels of the window count.
    if (double(width) * double(height) * shape.stored_bytes_per_texel >
        most_expansion(shape.compression) * double(file_size))
        return damaged(fmt::format("file ends too early: {} bytes cannot hold {} x {} texels by its compression",
                                   file_size, width, height));
    // The library keeps in memory a row of tiles, and a few blocks as stored and as decoded.
    const std::int64_t band = (tiled ? (width + block_width - 1) / block_width * block_width : width) * block_height;
    if (band > max_bytes / 4 / shape.bytes_per_texel)
        return Error{
            fmt::format("decoding blocks of {} x {} texels of {} bytes needs more memory than the limit of {} bytes",
                        block_width, block_height, shape.bytes_per_texel, max_bytes),
            "", ""};
    return {};
}

}  // namespace

Result<void> check_exr_black(const ExrWindow& display, const ExrWindow& data, const ReaderOptions& options) {
    static constexpr std::int64_t k_none = 0;
    const auto texels = [](const ExrWindow& w) {
        return std::max(k_none, std::int64_t(w[2]) - w[0] + 1) * std::max(k_none, std::int64_t(w[3]) - w[1] + 1);
    };
    const ExrWindow seen{std::max(display[0], data[0]), std::max(display[1], data[1]), std::min(display[2], data[2]),
                         std::min(display[3], data[3])};
    const std::int64_t black = texels(display) - texels(seen);
    const std::int64_t most = std::min(options.max_black, options.max_bytes / std::int64_t(3 * sizeof(float)));
    if (black <= 4 * texels(seen) || black <= most) return {};
    return Error{fmt::format("the display window has {} texels, but the data window only {} of them: more than the "
                             "limit of {} would be black",
                             texels(display), texels(seen), most),
                 "", "Crop the picture to its data window, or enlarge the data window to what is to be read."};
}

Result<ExrPreflight> check_exr_headers(std::span<const std::uint8_t> file, std::int64_t max_bytes) {
    const Error endless = damaged("file ends inside the header");
    Cursor cursor(file, std::min<std::size_t>(4, file.size()));
    const auto version = cursor.int32();
    if (!version) return endless;
    const bool multi_part = std::uint32_t(*version) & k_multi_part;

    ExrPreflight result;
    std::vector<std::pair<std::size_t, std::size_t>> crossed_out;  // where type names start, and how long they are
    PartShape shape;
    for (int attributes = 0, parts = 0;;) {
        const std::size_t start = cursor.at();
        const auto name = cursor.text();
        if (!name) return endless;
        if (name->empty()) {
            if (multi_part && attributes == 0) break;  // an empty header ends the list of parts
            if (const auto checked = check_part(shape, file.size(), max_bytes); !checked) return checked.error();
            if (!multi_part) break;
            if (++parts > 4096) return Error{"file has more than 4096 parts", "", ""};
            attributes = 0;
            shape = {};
            continue;
        }
        ++attributes;
        const auto type = cursor.text();
        if (!type) return endless;
        const auto size = cursor.int32();
        if (!size || *size < 0) return damaged("an attribute has no size");
        const std::size_t value_at = cursor.at();
        if (!cursor.skip(std::size_t(*size)))
            return damaged(fmt::format("attribute \"{}\" reaches past the end of the file", printable(*name)));
        const auto needed =
            std::find_if(k_needed.begin(), k_needed.end(), [&](const Needed& n) { return n.name == *name; });
        if (needed == k_needed.end()) {
            crossed_out.emplace_back(start + name->size() + 1, type->size());
        } else if (*type != needed->type || (needed->size != k_any_size && *size != needed->size)) {
            return damaged(fmt::format("attribute \"{}\" has the wrong type or size", *name));
        }
        if (const auto read = read_attribute(*name, file.subspan(value_at, std::size_t(*size)), shape); !read)
            return read.error();
    }
    result.headers.resize(cursor.at());
    std::memcpy(result.headers.data(), file.data(), cursor.at());
    for (const auto& [at, length] : crossed_out) std::memset(result.headers.data() + at, '-', length);
    return result;
}

}  // namespace domelight
