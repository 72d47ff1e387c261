#include "io/picture/png_colour.h"

#include "io/picture/icc_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

using Chunk = std::optional<std::span<const std::uint8_t>>;

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
    return value;
}

/// The chunk, if it is as long as it must be.
Chunk chunk_of_length(std::span<const std::uint8_t> file, std::string_view type, std::size_t length) {
    const Chunk chunk = find_png_chunk(file, type);
    return chunk && chunk->size() == length ? chunk : std::nullopt;
}

/// Eight numbers in units of 1e-5, the white first.
ColourPrimaries chromaticities(std::span<const std::uint8_t> chrm) {
    const auto xy = [&](std::size_t i) {
        return ColourPrimaries::Xy{big_endian(chrm, 8 * i) / 1e5, big_endian(chrm, 8 * i + 4) / 1e5};
    };
    return {xy(1), xy(2), xy(3), xy(0)};
}

/// By gAMA and cHRM, each of which may be missing.
PngColour by_gamma(std::span<const std::uint8_t> file, int levels) {
    PngColour result{colour_of_decode(Decode::srgb, levels), true};
    const Chunk gama = chunk_of_length(file, "gAMA", 4), chrm = chunk_of_length(file, "cHRM", 32);
    if (gama) {
        const double gamma = big_endian(*gama, 0) / 1e5;
        if (gamma >= 0.01 && gamma <= 100) {
            set_curves(result.colour, levels, [&](double v) { return std::pow(v, 1 / gamma); });
            result.colour.notes.push_back(gamma == 1 ? "values are linear, as gAMA says"
                                                     : fmt::format("gAMA {:g} was undone", gamma));
            result.assumed = false;
        } else {
            result.colour.notes.push_back(fmt::format("gAMA is {:g}, which is no curve: ignored", gamma));
        }
    }
    if (chrm) set_primaries(result.colour, chromaticities(*chrm), "the chromaticities of cHRM");
    return result;
}

}  // namespace

Chunk find_png_chunk(std::span<const std::uint8_t> file, std::string_view type) {
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t length = big_endian(file, at);
        if (length > file.size() - at - 12) break;
        if (std::equal(type.begin(), type.end(), file.begin() + std::ptrdiff_t(at + 4)))
            return file.subspan(at + 8, length);
        at += 12 + length;
    }
    return std::nullopt;
}

PngColour colour_of_png(std::span<const std::uint8_t> file, std::span<const std::uint8_t> icc_profile, int levels) {
    std::vector<std::string> ignored;
    const auto finished = [&](PngColour result) {
        result.colour.notes.insert(result.colour.notes.begin(), ignored.begin(), ignored.end());
        return result;
    };
    if (const Chunk cicp = chunk_of_length(file, "cICP", 4)) {
        const auto& c = *cicp;
        auto colour = colour_of_code_points({c[0], c[1], c[2], c[3] != 0}, levels);
        if (colour) return finished({*std::move(colour)});
        ignored.push_back("cICP is ignored: " + colour.error().what);
    }
    if (!icc_profile.empty()) {
        auto colour = colour_of_icc_profile(icc_profile, levels);
        if (colour) return finished({*std::move(colour)});
        ignored.push_back(colour.error().what + ": ignored");
    }
    if (find_png_chunk(file, "sRGB")) return finished({colour_of_decode(Decode::srgb, levels)});
    return finished(by_gamma(file, levels));
}

}  // namespace domelight
