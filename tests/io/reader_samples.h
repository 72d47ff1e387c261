#pragma once
// Small images that the tests of the readers write byte by byte, and helpers that read them.

#include "io/image_reader.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace domelight::test {

using Bytes = std::vector<std::uint8_t>;
using Rgbe = std::array<std::uint8_t, 4>;

inline Bytes bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

inline Bytes joined(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline void save(const std::filesystem::path& file, const Bytes& bytes) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

inline Bytes load(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline Result<std::unique_ptr<ImageReader>> open_bytes(Bytes bytes, const ReaderOptions& options = {}) {
    return open_image_reader(FileBytes::from_memory(std::move(bytes)), options);
}

/// All rows, read `rows_a_read` at a time.
inline Result<ImageF> read_all(ImageReader& reader, int rows_a_read = 5) {
    ImageF image(reader.facts().width, reader.facts().height, 3);
    for (int y = 0; y < image.height(); y += rows_a_read) {
        const auto read = reader.read(image.view().rows(y, std::min(rows_a_read, image.height() - y)));
        if (!read) return read.error();
    }
    return image;
}

inline Result<ImageF> read_bytes(Bytes bytes, const ReaderOptions& options = {}) {
    auto reader = open_bytes(std::move(bytes), options);
    if (!reader) return reader.error();
    return read_all(**reader);
}

inline bool same_pixels(const ImageF& a, const ImageF& b) {
    return a.width() == b.width() && a.height() == b.height() &&
           std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin());
}

/// A Radiance header.
inline Bytes hdr_header(const std::string& resolution, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n") {
    return bytes_of("#?RADIANCE\n" + variables + "\n" + resolution + "\n");
}

/// A scanline as four components in literal runs of at most 100 and repeated runs where four or more bytes are equal.
inline Bytes new_rle_scanline(const std::vector<Rgbe>& texels) {
    const int n = int(texels.size());
    Bytes out{2, 2, std::uint8_t(n >> 8), std::uint8_t(n & 255)};
    for (std::size_t c = 0; c < 4; ++c)
        for (int x = 0; x < n;) {
            const auto run_at = [&](int at) {
                int end = at + 1;
                while (end < n && end - at < 127 && texels[std::size_t(end)][c] == texels[std::size_t(at)][c]) ++end;
                return end - at;
            };
            if (const int run = run_at(x); run >= 4) {
                out.push_back(std::uint8_t(128 + run));
                out.push_back(texels[std::size_t(x)][c]);
                x += run;
                continue;
            }
            int end = x + 1;
            while (end < n && end - x < 100 && run_at(end) < 4) ++end;
            out.push_back(std::uint8_t(end - x));
            for (; x < end; ++x) out.push_back(texels[std::size_t(x)][c]);
        }
    return out;
}

inline Bytes flat_scanline(const std::vector<Rgbe>& texels) {
    Bytes out;
    for (const Rgbe& t : texels) out.insert(out.end(), t.begin(), t.end());
    return out;
}

/// Old run-length: a texel, then 1 1 1 n for n repetitions, low byte of n first.
inline Bytes old_rle_scanline(const std::vector<Rgbe>& texels) {
    Bytes out;
    for (std::size_t x = 0; x < texels.size();) {
        std::size_t end = x + 1;
        while (end < texels.size() && texels[end] == texels[x]) ++end;
        out.insert(out.end(), texels[x].begin(), texels[x].end());
        for (std::size_t n = end - x - 1; n > 0; n >>= 8) {
            const Bytes repeat{1, 1, 1, std::uint8_t(n & 255)};
            out.insert(out.end(), repeat.begin(), repeat.end());
        }
        x = end;
    }
    return out;
}

}  // namespace domelight::test
