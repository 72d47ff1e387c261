#include "io/hdr/hdr_header_reader.h"

#include "base/read_number.h"
#include "io/file/printable.h"
#include "io/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace domelight {

namespace {

constexpr std::size_t k_longest_header = 1 << 20;

/// The next line without its end; `at` moves past it. Empty if no line ends before the limit.
std::optional<std::string_view> next_line(std::span<const std::uint8_t> file, std::size_t& at) {
    const std::size_t limit = std::min(file.size(), k_longest_header);
    const auto begin = file.begin() + std::ptrdiff_t(std::min(at, limit));
    const auto end = std::find(begin, file.begin() + std::ptrdiff_t(limit), std::uint8_t('\n'));
    if (end == file.begin() + std::ptrdiff_t(limit)) return std::nullopt;
    std::string_view line(reinterpret_cast<const char*>(&*begin), std::size_t(end - begin));
    at += line.size() + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

/// All numbers of a text separated by blanks.
std::vector<double> numbers_in(std::string_view text) {
    std::vector<double> numbers;
    const char *at = text.data(), *end = at + text.size();
    for (;;) {
        while (at < end && (*at == ' ' || *at == '\t' || *at == '+')) ++at;
        double value = 0;
        const char* stopped = read_number(at, end, value);
        if (!stopped) return numbers;
        numbers.push_back(value);
        at = stopped;
    }
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

/// EXPOSURE (one number) and COLORCORR (three) are cumulative: the values of all lines are multiplied.
void apply_factors(HdrHeader& header, std::string_view name, const std::vector<double>& factors, std::size_t expected) {
    const bool usable = factors.size() == expected && std::all_of(factors.begin(), factors.end(), [](double f) {
                            return std::isfinite(f) && f > 1e-30 && f < 1e30;
                        });
    if (!usable) {
        header.warnings.push_back(fmt::format("a {} line does not hold {} positive number{}: ignored", name, expected,
                                              expected == 1 ? "" : "s"));
        return;
    }
    for (int c = 0; c < 3; ++c) header.applied[c] *= factors[expected == 1 ? 0 : c];
}

void apply_primaries(HdrHeader& header, const std::vector<double>& n) {
    if (n.size() != 8) {
        header.warnings.push_back("the PRIMARIES line does not hold 8 numbers: ignored");
        return;
    }
    // Common tools write eight zeros if they do not know the primaries.
    if (std::all_of(n.begin(), n.end(), [](double v) { return v == 0; })) return;
    header.primaries = ColourPrimaries{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
}

void apply_gamma(HdrHeader& header, const std::vector<double>& numbers) {
    const bool usable = numbers.size() == 1 && numbers[0] >= 0.1 && numbers[0] <= 1;
    if (usable) {
        header.gamma = numbers[0];
    } else {
        header.warnings.push_back("the GAMMA line does not hold a number from 0.1 to 1: ignored");
    }
}

Result<void> apply_variable(HdrHeader& header, std::string_view line) {
    const std::size_t equals = line.find('=');
    // Radiance's tools leave their command lines in the header.
    header.by_radiance |= line.starts_with("ra_xyze ");
    if (equals == std::string_view::npos) return {};
    const std::string_view name = line.substr(0, equals), value = line.substr(equals + 1);
    if (name == "FORMAT") {
        if (trimmed(value) == "32-bit_rle_xyze") {
            header.xyze = true;
        } else if (trimmed(value) != "32-bit_rle_rgbe") {
            return Error{
                fmt::format("FORMAT is \"{}\", not 32-bit_rle_rgbe or 32-bit_rle_xyze", printable(trimmed(value))), "",
                ""};
        }
    } else if (name == "EXPOSURE") {
        apply_factors(header, name, numbers_in(value), 1);
    } else if (name == "COLORCORR") {
        apply_factors(header, name, numbers_in(value), 3);
    } else if (name == "PRIMARIES") {
        apply_primaries(header, numbers_in(value));
    } else if (name == "GAMMA") {
        apply_gamma(header, numbers_in(value));
    } else if (name == "SOFTWARE") {
        header.by_radiance |= trimmed(value).starts_with("RADIANCE");
    }
    return {};
}

/// "-Y 512 +X 1024" and its seven variants.
Result<void> apply_resolution(HdrHeader& header, std::string_view line) {
    const Error broken{fmt::format("resolution line is \"{}\", not like \"-Y 512 +X 1024\"", printable(line)), "", ""};
    char axis[2] = {};
    char sign[2] = {};
    long long size[2] = {};
    const char *at = line.data(), *end = at + line.size();
    for (int i = 0; i < 2; ++i) {
        while (at < end && *at == ' ') ++at;
        if (end - at < 3 || (at[0] != '+' && at[0] != '-') || (at[1] != 'X' && at[1] != 'Y')) return broken;
        sign[i] = at[0], axis[i] = at[1];
        at += 2;
        while (at < end && *at == ' ') ++at;
        const auto [stopped, code] = std::from_chars(at, end, size[i]);
        if (code != std::errc()) return broken;
        at = stopped;
    }
    if (axis[0] == axis[1]) return broken;
    const int x = axis[0] == 'X' ? 0 : 1, y = 1 - x;
    if (const auto sized = check_image_size(size[x], size[y]); !sized) return sized.error();
    header.width = int(size[x]), header.height = int(size[y]);
    header.columns = x == 0;
    header.flip_x = sign[x] == '-', header.flip_y = sign[y] == '+';
    return {};
}

}  // namespace

Result<HdrHeader> read_hdr_header(std::span<const std::uint8_t> file) {
    const Error endless{"file ends inside the header", "", ""};
    HdrHeader header;
    std::size_t at = 0;
    for (bool first = true;; first = false) {
        const auto line = next_line(file, at);
        if (!line) return endless;
        if (line->empty() && !first) break;
        if (line->starts_with('#')) continue;
        if (const auto applied = apply_variable(header, *line); !applied) return applied.error();
    }
    const auto resolution = next_line(file, at);
    if (!resolution) return endless;
    if (const auto applied = apply_resolution(header, *resolution); !applied) return applied.error();
    header.data_offset = at;
    return header;
}

}  // namespace domelight
