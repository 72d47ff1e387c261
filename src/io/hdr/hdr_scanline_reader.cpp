#include "io/hdr/hdr_scanline_reader.h"

#include <algorithm>
#include <cstring>

namespace domelight {

namespace {

constexpr const char* k_truncated = "file ends inside a scanline";
constexpr const char* k_overrun = "a run passes the end of its scanline";

bool is_new_rle(std::span<const std::uint8_t> data, int width) {
    // Radiance itself: narrower or wider scanlines, or a third byte over 127, are of the old kind.
    return width >= 8 && width < 32768 && data.size() >= 4 && data[0] == 2 && data[1] == 2 && data[2] < 128;
}

/// `run(c, x, n, value)` and `copy(c, x, n, from)` for each piece of component c in turn.
template <typename Run, typename Copy>
ScanlineStep walk_new_rle(std::span<const std::uint8_t> data, int width, const Run& run, const Copy& copy) {
    if ((data[2] << 8 | data[3]) != width) return {0, "a scanline is not as long as the header says"};
    std::size_t at = 4;
    for (int c = 0; c < 4; ++c) {
        for (int x = 0; x < width;) {
            if (at + 2 > data.size()) return {0, k_truncated};
            const int code = data[at++];
            if (code > 128) {
                const int n = code - 128;
                if (n > width - x) return {0, k_overrun};
                run(c, x, n, data[at++]);
                x += n;
            } else {
                if (code == 0 || code > width - x) return {0, code ? k_overrun : "a run is empty"};
                if (data.size() - at < std::size_t(code)) return {0, k_truncated};
                copy(c, x, code, data.data() + at);
                at += code;
                x += code;
            }
        }
    }
    return {at, nullptr};
}

/// `texel(x, rgbe)` and `repeat(x, n)` (of texel x - 1) for each piece.
template <typename Texel, typename Repeat>
ScanlineStep walk_old_rle(std::span<const std::uint8_t> data, int width, const Texel& texel, const Repeat& repeat) {
    std::size_t at = 0;
    int shift = 0;
    for (int x = 0; x < width; at += 4) {
        if (data.size() - at < 4) return {0, k_truncated};
        const std::uint8_t* rgbe = data.data() + at;
        if (rgbe[0] == 1 && rgbe[1] == 1 && rgbe[2] == 1) {
            if (x == 0) return {0, "a scanline starts with a repetition"};
            // With more than two bytes the count would exceed every accepted width, unless the byte is 0.
            const int n = shift < 24 ? int(rgbe[3]) << shift : (rgbe[3] ? width : 0);
            if (n > width - x) return {0, k_overrun};
            if (n == 0 && shift >= 24) return {0, "a repetition never ends"};
            repeat(x, n);
            x += n;
            shift += 8;
        } else {
            texel(x++, rgbe);
            shift = 0;
        }
    }
    return {at, nullptr};
}

/// Copies n <= 128 bytes as 16, 32 or 128: a few wide moves are cheaper than computing how many are needed. The bytes
/// after the end belong to components that are decoded later, or to the slack.
void copy_short(std::uint8_t* to, const std::uint8_t* from, int n) {
    if (n <= 16) {
        std::memcpy(to, from, 16);
    } else if (n <= 32) {
        std::memcpy(to, from, 32);
    } else {
        std::memcpy(to, from, 128);
    }
}

void fill_short(std::uint8_t* to, int value, int n) {
    if (n <= 16) {
        std::memset(to, value, 16);
    } else {
        std::memset(to, value, 128);
    }
}

}  // namespace

ScanlineStep skip_hdr_scanline(std::span<const std::uint8_t> data, int width) {
    if (is_new_rle(data, width)) {
        return walk_new_rle(
            data, width, [](int, int, int, int) {}, [](int, int, int, const std::uint8_t*) {});
    }
    return walk_old_rle(
        data, width, [](int, const std::uint8_t*) {}, [](int, int) {});
}

ScanlineStep decode_hdr_scanline(std::span<const std::uint8_t> data, int width, std::uint8_t* planes,
                                 std::size_t plane_stride) {
    if (is_new_rle(data, width)) {
        const std::uint8_t* const last_wide_copy = data.data() + data.size() - std::min<std::size_t>(data.size(), 128);
        return walk_new_rle(
            data, width, [&](int c, int x, int n, int value) { fill_short(planes + c * plane_stride + x, value, n); },
            [&](int c, int x, int n, const std::uint8_t* from) {
                std::uint8_t* to = planes + c * plane_stride + x;
                if (from <= last_wide_copy) {
                    copy_short(to, from, n);
                } else {
                    std::memcpy(to, from, std::size_t(n));
                }
            });
    }
    return walk_old_rle(
        data, width,
        [&](int x, const std::uint8_t* rgbe) {
            for (int c = 0; c < 4; ++c) planes[c * plane_stride + x] = rgbe[c];
        },
        [&](int x, int n) {
            for (int c = 0; c < 4; ++c) {
                std::uint8_t* plane = planes + c * plane_stride;
                std::memset(plane + x, plane[x - 1], std::size_t(n));
            }
        });
}

std::size_t least_hdr_scanline_bytes(int width) {
    // One texel, then repetitions of 255, 255 << 8, ...: always less than what the new encoding needs.
    std::size_t bytes = 4;
    long long covered = 1;
    for (int shift = 0; covered < width; shift += 8, bytes += 4) covered += 255LL << shift;
    return bytes;
}

}  // namespace domelight
