#include "io/picture/texture_image.h"

#include "io/image_reader.h"
#include "io/picture/foreign_format.h"
#include "io/picture/jpeg_segments.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace domelight {

namespace {

enum class Format { png, jpeg, webp, other };

Format format_of(std::span<const std::uint8_t> bytes) {
    const auto starts = [&](const char* magic, std::size_t n, std::size_t at = 0) {
        return bytes.size() >= at + n && std::memcmp(bytes.data() + at, magic, n) == 0;
    };
    if (starts("\x89PNG\r\n\x1a\n", 8)) return Format::png;
    if (starts("\xff\xd8", 2)) return Format::jpeg;
    if (starts("RIFF", 4) && starts("WEBP", 4, 8)) return Format::webp;
    return Format::other;
}

Error not_read(std::span<const std::uint8_t> bytes) {
    const auto foreign = foreign_format(bytes);
    if (!foreign) return {"neither PNG nor JPEG nor WebP", "", ""};
    return {foreign->name + ", neither PNG nor JPEG nor WebP", "", foreign->hint};
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
    return value;
}

/// By the frame header of a JPEG (ISO 10918-1, B.2.2).
Result<TextureSize> jpeg_size(std::span<const std::uint8_t> bytes) {
    for (const auto& [marker, contents] : jpeg_segments(bytes)) {
        const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame && contents.size() >= 5)
            return TextureSize{int(big_endian(contents, 3, 2)), int(big_endian(contents, 1, 2))};
    }
    return Error{"not a readable JPEG: no frame header", "", "The file is truncated or damaged."};
}

Result<TextureSize> claimed_size(std::span<const std::uint8_t> bytes) {
    switch (format_of(bytes)) {
        case Format::png:
            if (bytes.size() < 33) return Error{"not a readable PNG: file ends too early", "", ""};
            return TextureSize{int(big_endian(bytes, 16, 4) & 0x7fffffff), int(big_endian(bytes, 20, 4) & 0x7fffffff)};
        case Format::jpeg:
            return jpeg_size(bytes);
        case Format::webp:
            return webp_size(bytes);
        default:
            return not_read(bytes);
    }
}

}  // namespace

Result<TextureSize> texture_image_size(std::span<const std::uint8_t> bytes) {
    const auto size = claimed_size(bytes);
    if (!size) return size;
    if (const auto sized = check_image_size(size->width, size->height); !sized) return sized.error();
    // A block of 32 x 32 texels takes a bit of a JPEG, and Deflate turns a byte into 1032 (8 texels each at best).
    // Lossless WebP has no such bound: one colour takes no bits at all; four megatexels are let pass.
    const std::uint64_t texels = std::uint64_t(size->width) * std::uint64_t(size->height);
    if (texels / 8320 > bytes.size() + 512)
        return Error{fmt::format("file ends too early: {} bytes cannot hold {} x {} texels", bytes.size(), size->width,
                                 size->height),
                     "", "The file is truncated, or its header is wrong."};
    return size;
}

Result<Rgba8Image> decode_jpeg_texture(std::span<const std::uint8_t> bytes) {
    const auto size = texture_image_size(bytes);
    if (!size) return size.error();
    // The reader of environments returns code / 255 as float, from which the codes can be recovered exactly.
    auto reader = open_jpeg_reader(FileBytes::from_memory({bytes.begin(), bytes.end()}),
                                   {.decode = Decode::linear, .as_stored = true});
    if (!reader) return reader.error();
    Rgba8Image image;
    image.width = (*reader)->facts().width, image.height = (*reader)->facts().height;
    image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
    ImageF row(image.width, 1, 3);
    std::uint8_t* out = image.rgba.data();
    for (int y = 0; y < image.height; ++y) {
        if (const auto read = (*reader)->read(row.view()); !read) return read.error();
        for (int x = 0; x < image.width; ++x, out += 4) {
            for (int c = 0; c < 3; ++c) out[c] = std::uint8_t(row.at(x, 0)[c] * 255 + 0.5f);
            out[3] = 255;
        }
    }
    return image;
}

Result<Rgba8Image> decode_texture_image(std::span<const std::uint8_t> bytes) {
    switch (format_of(bytes)) {
        case Format::png:
            return decode_png_texture(bytes);
        case Format::jpeg:
            return decode_jpeg_texture(bytes);
        case Format::webp:
            return decode_webp_texture(bytes);
        default:
            return not_read(bytes);
    }
}

}  // namespace domelight
