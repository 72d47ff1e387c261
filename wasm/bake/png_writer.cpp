// PNG pictures, byte for byte as io/picture/png_writer.cpp has libpng write them (PNG specification, third edition; section numbers are its).

#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "deflate.h"
#include "io/picture/png_memory.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace domelight {

namespace {

void add_u32(PngBytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(value >> shift));
}

/// Section 5.3.
void add_chunk(PngBytes& out, std::string_view type, std::span<const std::uint8_t> data) {
    add_u32(out, std::uint32_t(data.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), data.begin(), data.end());
    add_u32(out, std::uint32_t(crc32(0, out.data() + start, uInt(out.size() - start))));
}

/// Section 9.4: the neighbour (left, above, above left) that is nearest to left + above - above left.
int paeth(int left, int above, int above_left) {
    const int estimate = left + above - above_left;
    const int a = std::abs(estimate - left), b = std::abs(estimate - above), c = std::abs(estimate - above_left);
    return a <= b && a <= c ? left : b <= c ? above : above_left;
}

/// All rows, each behind the number of its filter. libpng uses none for pictures of one row or one column.
std::vector<std::uint8_t> filtered_rows(ImageView<const std::uint8_t> pixels, bool filter) {
    const int row_bytes = pixels.width * pixels.channels, step = pixels.channels;
    std::vector<std::uint8_t> out;
    out.reserve((std::size_t(row_bytes) + 1) * std::size_t(pixels.height));
    for (int y = 0; y < pixels.height; ++y) {
        const std::uint8_t *row = pixels.row(y), *above = y > 0 ? pixels.row(y - 1) : nullptr;
        out.push_back(filter ? 4 : 0);
        for (int i = 0; i < row_bytes; ++i) {
            const int left = i >= step ? row[i - step] : 0, up = above ? above[i] : 0;
            const int predicted = filter ? paeth(left, up, above && i >= step ? above[i - step] : 0) : 0;
            out.push_back(std::uint8_t(row[i] - predicted));
        }
    }
    return out;
}

/// The window that libpng chooses for so many bytes. It states the least that the data needs in the first two bytes.
int window_bits(std::size_t size) {
    int bits = 15;
    while (size <= 16384 && size + 262 <= std::size_t(1) << (bits - 1)) --bits;
    return std::max(bits, 9);
}
void state_least_window(std::vector<std::uint8_t>& packed, std::size_t size) {
    unsigned info = packed[0] >> 4;
    if (size > 16384 || size > 1u << (info + 7)) return;
    do --info;
    while (info > 0 && size <= 1u << (info + 7));
    const unsigned first = 8 | info << 4, flags = packed[1] & 0xe0u;
    packed[0] = std::uint8_t(first);
    packed[1] = std::uint8_t(flags + 31 - ((first << 8) + flags) % 31);
}

struct PngStyle {
    bool srgb;
    int level;
    bool runs;
};

PngBytes png_of(ImageView<const std::uint8_t> pixels, const PngStyle& style) {
    constexpr std::array<std::uint8_t, 8> k_signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    constexpr std::size_t k_idat_bytes = 8192;  // libpng's
    PngBytes out(k_signature.begin(), k_signature.end()), head;
    add_u32(head, std::uint32_t(pixels.width));
    add_u32(head, std::uint32_t(pixels.height));
    const std::uint8_t colour = pixels.channels == 1 ? 0 : pixels.channels == 3 ? 2 : 6;
    for (const std::uint8_t byte : {std::uint8_t(8), colour, std::uint8_t(0), std::uint8_t(0), std::uint8_t(0)}) head.push_back(byte);
    add_chunk(out, "IHDR", head);
    if (style.srgb) {
        PngBytes gamma, chromaticities;
        add_u32(gamma, 45455);
        for (const std::uint32_t value : {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000}) add_u32(chromaticities, value);
        add_chunk(out, "gAMA", gamma);
        add_chunk(out, "sRGB", std::array<std::uint8_t, 1>{0});
        add_chunk(out, "cHRM", chromaticities);
    }
    const bool filter = pixels.width > 1 && pixels.height > 1;
    const auto rows = filtered_rows(pixels, filter);
    auto packed = deflated(rows, style.level, style.runs ? Z_RLE : filter ? Z_FILTERED : Z_DEFAULT_STRATEGY, window_bits(rows.size()));
    state_least_window(packed, rows.size());
    for (std::size_t at = 0; at < packed.size(); at += k_idat_bytes)
        add_chunk(out, "IDAT", std::span(packed).subspan(at, std::min(k_idat_bytes, packed.size() - at)));
    add_chunk(out, "IEND", {});
    return out;
}

}  // namespace

Result<void> write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels, int compression_level) {
    return write_file_atomically(file, std::span<const std::uint8_t>(png_of(pixels, {.srgb = true, .level = compression_level, .runs = true})));
}

Result<PngBytes> encode_png(ImageView<const std::uint8_t> pixels, int compression_level) {
    return png_of(pixels, {.srgb = false, .level = compression_level, .runs = false});
}

}  // namespace domelight
