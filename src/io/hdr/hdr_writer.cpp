// Writes Radiance HDR pictures (Ward, "The RADIANCE Picture File Format"; Real Pixels, Graphics Gems II).
#include "domelight/base/parallel.h"
#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "io/file/output_file.h"
#include "texture/texel/rgbe.h"

#include <string>
#include <vector>

namespace domelight {

namespace {

/// Run-length encoding stores the length of a row in 15 bits, and shorter rows would be mistaken for old files.
constexpr int k_min_rle_width = 8, k_max_rle_width = 32767;
/// The number of rows encoded at a time: enough for all threads, but little memory.
constexpr int k_block_rows = 64;

/// Appends one channel of a row: a byte above 128 repeats the next byte (byte - 128) times, another is followed by as
/// many bytes.
void append_runs(const std::uint8_t* values, int count, std::vector<std::uint8_t>& out) {
    constexpr int k_min_run = 4, k_max_run = 127, k_max_literal = 128;
    const auto run_length = [&](int at) {
        int n = 1;
        while (n < k_max_run && at + n < count && values[at + n] == values[at]) ++n;
        return n;
    };
    for (int at = 0; at < count;) {
        int run_at = at, run = 0;
        while (run_at < count && (run = run_length(run_at)) < k_min_run) run_at += run;
        while (at < run_at) {
            const int literal = std::min(run_at - at, k_max_literal);
            out.push_back(std::uint8_t(literal));
            out.insert(out.end(), values + at, values + at + literal);
            at += literal;
        }
        if (at < count) {
            out.push_back(std::uint8_t(128 + run));
            out.push_back(values[at]);
            at += run;
        }
    }
}

std::vector<std::uint8_t> encode_row(const float* rgb, int width) {
    std::vector<std::uint8_t> out;
    const bool flat = width < k_min_rle_width || width > k_max_rle_width;
    out.reserve(std::size_t(width) * 4 + 64);
    std::vector<std::uint8_t> channels(flat ? 0 : std::size_t(width) * 4);
    for (int x = 0; x < width; ++x) {
        const auto rgbe = rgbe_from_rgb(rgb[3 * x], rgb[3 * x + 1], rgb[3 * x + 2]);
        if (flat)
            out.insert(out.end(), rgbe.begin(), rgbe.end());
        else
            for (int c = 0; c < 4; ++c)
                channels[std::size_t(c) * std::size_t(width) + std::size_t(x)] = rgbe[std::size_t(c)];
    }
    if (flat) return out;
    for (int byte : {2, 2, width >> 8, width & 255}) out.push_back(std::uint8_t(byte));
    for (int c = 0; c < 4; ++c) append_runs(channels.data() + std::size_t(c) * std::size_t(width), width, out);
    return out;
}

}  // namespace

Result<void> write_hdr(const std::filesystem::path& file, RowSource& rows, int threads) {
    const int width = rows.width(), height = rows.height();
    return write_file_atomically(file, [&](const std::filesystem::path& path) -> Result<void> {
        OutputFile out(path);
        out.write(std::span<const char>("#?RADIANCE\nSOFTWARE=Domelight " + std::string(version()) +
                                        "\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                                        std::to_string(width) + "\n"));
        ImageF block(width, std::min(height, k_block_rows), 3);
        for (int y = 0; y < height && !out.failed(); y += k_block_rows) {
            const int count = std::min(k_block_rows, height - y);
            Result<void> read = rows.read(block.view().rows(0, count));
            if (!read) return read;
            std::vector<std::vector<std::uint8_t>> encoded(static_cast<std::size_t>(count));
            parallel_for(count, threads, [&](int i) { encoded[std::size_t(i)] = encode_row(block.row(i), width); });
            std::vector<std::uint8_t> joined;
            for (const auto& row : encoded) joined.insert(joined.end(), row.begin(), row.end());
            out.write(joined);
        }
        return out.finish();
    });
}

Result<void> write_hdr(const std::filesystem::path& file, ImageView<const float> rgb, int threads) {
    ImageRowSource rows(rgb);
    return write_hdr(file, rows, threads);
}

}  // namespace domelight
