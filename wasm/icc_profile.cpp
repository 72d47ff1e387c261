// ICC profiles of curves and a matrix, or of one curve: those of nearly all pictures. io/picture/icc_profile.cpp reads all kinds, by Little CMS, which is as large as all
// other decoders together. Section numbers are those of ICC.1:2022.

#include "io/picture/icc_profile.h"

#include "io/file/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t signature(const char (&name)[5]) {
    return std::uint32_t(name[0]) << 24 | std::uint32_t(name[1]) << 16 | std::uint32_t(name[2]) << 8 | std::uint32_t(name[3]);
}
/// A number of `count` bytes; 0 past the end.
std::uint32_t number(Bytes bytes, std::size_t at, std::size_t count = 4) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0);
    return value;
}
double fixed(Bytes bytes, std::size_t at) {
    return std::int32_t(number(bytes, at)) / 65536.0;
}

/// A tag's data (section 7.3); empty: there is none.
Bytes find_tag(Bytes profile, std::uint32_t tag) {
    const std::size_t count = std::min<std::size_t>(number(profile, 128), 100);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t entry = 132 + 12 * i, offset = number(profile, entry + 4), size = number(profile, entry + 8);
        if (number(profile, entry) == tag && offset <= profile.size() && size <= profile.size() - offset) return profile.subspan(offset, size);
    }
    return {};
}

/// Section 10.18: functions of up to seven parameters.
std::optional<std::function<double(double)>> parametric(Bytes tag) {
    static constexpr std::size_t counts[] = {1, 3, 4, 5, 7};
    const std::uint32_t kind = number(tag, 8, 2);
    if (kind > 4 || tag.size() < 12 + 4 * counts[kind]) return std::nullopt;
    double p[7] = {};
    for (std::size_t i = 0; i < counts[kind]; ++i) p[i] = fixed(tag, 12 + 4 * i);
    const auto [g, a, b, c, d, e, f] = p;
    return [=](double x) {
        const auto power = [&](double offset) { return std::pow(std::max(a * x + b, 0.0), g) + offset; };
        switch (kind) {
            case 0: return std::pow(x, g);
            case 1: return x >= -b / a ? power(0) : 0;
            case 2: return x >= -b / a ? power(c) : c;
            case 3: return x >= d ? power(0) : c * x;
            default: return x >= d ? power(e) : c * x + f;
        }
    };
}

/// Section 10.6: a table of 16-bit values, or one exponent.
std::optional<std::function<double(double)>> tabulated(Bytes tag) {
    const std::size_t count = number(tag, 8);
    if (count > 65536 || tag.size() < 12 + 2 * count) return std::nullopt;
    if (count == 0) return [](double x) { return x; };
    if (count == 1) return [g = number(tag, 12, 2) / 256.0](double x) { return std::pow(x, g); };
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(number(tag, 12 + 2 * i, 2) / 65535.0);
    return [values](double x) {
        const double at = x * double(values.size() - 1);
        const std::size_t before = std::min(std::size_t(at), values.size() - 2);
        return values[before] + (at - double(before)) * (values[before + 1] - values[before]);
    };
}

bool set_channel(ScreenColour& colour, std::size_t channel, Bytes tag, int levels) {
    const std::uint32_t type = number(tag, 0);
    const auto curve = type == signature("para") ? parametric(tag) : type == signature("curv") ? tabulated(tag) : std::nullopt;
    if (!curve) return false;
    ScreenColour one;
    set_curves(one, levels, [&](double v) {
        const double light = (*curve)(v);
        return std::isfinite(light) ? std::clamp(light, 0.0, 1.0) : 0.0;
    });
    colour.curves[channel] = one.curves[0];
    return true;
}

/// The text of the description, in either of its forms (section 10.15, and of version 2).
std::string profile_name(Bytes profile) {
    const Bytes tag = find_tag(profile, signature("desc"));
    std::string name;
    if (number(tag, 0) == signature("desc")) {
        for (std::size_t i = 12; i < std::min<std::size_t>(tag.size(), 12 + number(tag, 8)) && tag[i]; ++i) name += char(tag[i]);
    } else if (number(tag, 0) == signature("mluc")) {
        const std::size_t length = number(tag, 20), at = number(tag, 24);
        for (std::size_t i = at + 1; i < std::min<std::size_t>(tag.size(), at + length); i += 2) name += tag[i - 1] ? '?' : char(tag[i]);
    }
    const std::string shown = printable(name, 60);
    return shown.empty() ? "the ICC profile" : fmt::format("the ICC profile \"{}\"", shown);
}

/// Section 8.4.3. The colourants are XYZ of D50.
std::optional<ScreenColour> by_matrix(Bytes profile, int levels) {
    static constexpr std::uint32_t curves[] = {signature("rTRC"), signature("gTRC"), signature("bTRC")};
    static constexpr std::uint32_t colourants[] = {signature("rXYZ"), signature("gXYZ"), signature("bXYZ")};
    ScreenColour colour;
    Mat3 columns;
    for (std::size_t c = 0; c < 3; ++c) {
        const Bytes xyz = find_tag(profile, colourants[c]);
        if (!set_channel(colour, c, find_tag(profile, curves[c]), levels) || xyz.size() < 20) return std::nullopt;
        columns.row[c] = {fixed(xyz, 8), fixed(xyz, 12), fixed(xyz, 16)};
    }
    colour.to_rec709 = rec709_of_colourants(columns.transposed());
    return colour;
}

Result<ScreenColour> by_kind(Bytes profile, int levels) {
    const Bytes points = find_tag(profile, signature("cicp"));
    if (points.size() >= 12 && points[10] == 0)
        if (auto colour = colour_of_code_points({points[8], points[9], points[10], points[11] != 0}, levels)) return colour;
    if (number(profile, 16) == signature("GRAY")) {
        ScreenColour colour;
        for (std::size_t c = 0; c < 3; ++c)
            if (!set_channel(colour, c, find_tag(profile, signature("kTRC")), levels)) return Error{"it has no curve", "", ""};
        return colour;
    }
    if (number(profile, 16) != signature("RGB ")) return Error{"it is neither of RGB nor of grey", "", ""};
    if (auto colour = by_matrix(profile, levels)) return *std::move(colour);
    return Error{"its tables are not read by the WebAssembly module", "", ""};
}

}  // namespace

Result<ScreenColour> colour_of_icc_profile(Bytes profile, int levels) {
    if (profile.size() < 132 || number(profile, 36) != signature("acsp")) return Error{"the ICC profile is damaged", "", ""};
    const std::string name = profile_name(profile);
    auto colour = by_kind(profile, levels);
    if (!colour) return Error{fmt::format("{} cannot be used: {}", name, colour.error().what), "", ""};
    if (is_srgb(*colour, levels)) return colour_of_decode(Decode::srgb, levels);
    colour->notes.insert(colour->notes.begin(), name + " was converted to linear Rec. 709");
    return colour;
}

}  // namespace domelight
