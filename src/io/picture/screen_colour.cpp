#include "io/picture/screen_colour.h"

#include "image/srgb_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// The inverse of ITU-R BT.709-6, item 1.2 (which BT.601 and BT.2020 share).
double bt709_to_linear(double v) {
    return v < 0.081 ? v / 4.5 : std::pow((v + 0.099) / 1.099, 1 / 0.45);
}

/// The white of a picture in HDR for a screen, in cd/m² (ITU-R BT.2408-7, section 2.1).
constexpr double k_hdr_white = 203;

/// SMPTE ST 2084, in units of that white.
double pq_to_linear(double v) {
    constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    const double p = std::pow(v, 1 / m2);
    return 10000 / k_hdr_white * std::pow(std::max(p - c1, 0.0) / (c2 - c3 * p), 1 / m1);
}

/// The inverse of HLG's OETF (ITU-R BT.2100-2, table 5), in units of the light of a signal of 75 %.
double hlg_to_linear(double v) {
    const auto scene = [](double e) {
        constexpr double a = 0.17883277, b = 0.28466892, c = 0.55991073;
        return e <= 0.5 ? e * e / 3 : (std::exp((e - c) / a) + b) / 12;
    };
    return scene(v) / scene(0.75);
}

struct Transfer {
    int code;
    const char* name;
    double (*light)(double);
    bool hdr = false;
};

/// ITU-T H.273, table 3.
constexpr Transfer k_transfers[] = {
    {1, "BT.709", bt709_to_linear},
    {4, "gamma 2.2", [](double v) { return std::pow(v, 2.2); }},
    {5, "gamma 2.8", [](double v) { return std::pow(v, 2.8); }},
    {6, "BT.601", bt709_to_linear},
    {8, "linear", [](double v) { return v; }},
    {13, "sRGB", [](double v) { return srgb_to_linear(v); }},
    {14, "BT.2020", bt709_to_linear},
    {15, "BT.2020", bt709_to_linear},
    {16, "PQ", pq_to_linear, true},
    {17, "SMPTE ST 428", [](double v) { return std::pow(v, 2.6) * 52.37 / 48; }},
    {18, "HLG", hlg_to_linear, true},
};

struct NamedPrimaries {
    int code;
    const char* name;
    ColourPrimaries primaries;
};

constexpr ColourPrimaries::Xy k_d65{0.3127, 0.3290}, k_c{0.310, 0.316};

/// ITU-T H.273, table 2.
constexpr NamedPrimaries k_primaries[] = {
    {1, "Rec. 709", {}},
    {4, "BT.470 M", {{0.67, 0.33}, {0.21, 0.71}, {0.14, 0.08}, k_c}},
    {5, "BT.470 BG", {{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, k_d65}},
    {6, "BT.601", {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, k_d65}},
    {7, "SMPTE ST 240", {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, k_d65}},
    {8, "film", {{0.681, 0.319}, {0.243, 0.692}, {0.145, 0.049}, k_c}},
    {9, "Rec. 2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, k_d65}},
    {10, "CIE XYZ", {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}}},
    {11, "DCI P3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.314, 0.351}}},
    {12, "Display P3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, k_d65}},
    {22, "EBU 3213", {{0.630, 0.340}, {0.295, 0.605}, {0.155, 0.077}, k_d65}},
};

template <typename Row, std::size_t n>
const Row* find_code(const Row (&table)[n], int code) {
    const auto* row = std::find_if(table, table + n, [&](const Row& r) { return r.code == code; });
    return row == table + n ? nullptr : row;
}

}  // namespace

void set_curves(ScreenColour& colour, int levels, const std::function<double(double)>& light) {
    std::vector<float> curve(static_cast<std::size_t>(levels));
    for (int i = 0; i < levels; ++i) curve[std::size_t(i)] = float(light(double(i) / (levels - 1)));
    colour.curves.fill(curve);
}

std::vector<float> screen_curve(Decode decode, int levels) {
    return colour_of_decode(decode, levels).curves[0];
}

ScreenColour colour_of_decode(Decode decode, int levels) {
    ScreenColour colour;
    set_curves(colour, levels, [&](double v) {
        return decode == Decode::linear ? v : decode == Decode::gamma22 ? std::pow(v, 2.2) : srgb_to_linear(v);
    });
    return colour;
}

void set_primaries(ScreenColour& colour, const ColourPrimaries& primaries, const std::string& what) {
    const std::optional<Mat3> matrix = rgb_to_rec709(primaries);
    if (!matrix) {
        colour.notes.push_back(what + " do not describe a colour space: ignored");
    } else if (!is_nearly_identity(*matrix)) {
        colour.to_rec709 = matrix;
        colour.notes.push_back(what + " were converted to linear Rec. 709");
    }
}

Result<ScreenColour> colour_of_code_points(const CodePoints& points, int levels) {
    const Transfer* transfer = find_code(k_transfers, points.transfer);
    const NamedPrimaries* primaries = find_code(k_primaries, points.primaries);
    if (!transfer) return Error{fmt::format("transfer function {} is not known", points.transfer), "", ""};
    if (!primaries) return Error{fmt::format("colour primaries {} are not known", points.primaries), "", ""};
    if (points.matrix != 0) return Error{fmt::format("matrix {} is not that of RGB (0)", points.matrix), "", ""};
    ScreenColour colour;
    // A narrow range has 16 for black and 235 for white, of 255; and the same with zeros behind for 16 bits.
    const double unit = levels / 256.0 / (levels - 1), black = points.full_range ? 0 : 16 * unit;
    const double range = points.full_range ? 1 : 219 * unit;
    set_curves(colour, levels, [&](double v) { return transfer->light(std::clamp((v - black) / range, 0.0, 1.0)); });
    colour.hdr = transfer->hdr;
    const std::string white = !colour.hdr ? "" : points.transfer == 16 ? ", 203 cd/m² being 1" : ", its white being 1";
    if (transfer->code != 13) colour.notes.push_back(fmt::format("{} was undone{}", transfer->name, white));
    set_primaries(colour, primaries->primaries, fmt::format("primaries of {}", primaries->name));
    return colour;
}

std::vector<std::string> screen_warnings(const std::string& format, const ScreenColour& colour, bool assumed) {
    std::vector<std::string> warnings;
    if (!colour.hdr)
        warnings.push_back(format + " is not HDR: values above 1 are clipped, so bright lights are too dim");
    if (assumed) warnings.push_back(format + " values are taken to be sRGB");
    warnings.insert(warnings.end(), colour.notes.begin(), colour.notes.end());
    return warnings;
}

}  // namespace domelight
