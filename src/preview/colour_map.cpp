#include "preview/colour_map.h"

#include "domelight/base/vec.h"

#include "preview/tonemap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

/// OKLab by lightness, chroma and hue (radians) to linear Rec. 709 (Ottosson 2020).
Vec3d linear_of_oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const auto cubed = [](double v) { return v * v * v; };
    const double l = cubed(lightness + 0.3963377774 * a + 0.2158037573 * b),
                 m = cubed(lightness - 0.1055613458 * a - 0.0638541728 * b),
                 s = cubed(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// The same with the chroma reduced until a display can show the colour, because readers judge by lightness and hue.
Colour8 shown(double lightness, double chroma, double hue) {
    const auto fits = [](const Vec3d& v) { return std::min({v.x, v.y, v.z}) >= 0 && std::max({v.x, v.y, v.z}) <= 1; };
    double low = 0, high = chroma;
    if (!fits(linear_of_oklch(lightness, chroma, hue)))
        for (int i = 0; i < 24; ++i) {
            const double middle = (low + high) / 2;
            (fits(linear_of_oklch(lightness, middle, hue)) ? low : high) = middle;
        }
    else
        low = chroma;
    const Vec3d v = linear_of_oklch(lightness, low, hue);
    const auto byte = [](double c) { return to_byte(srgb_encode(float(std::clamp(c, 0.0, 1.0)))); };
    return {byte(v.x), byte(v.y), byte(v.z)};
}

using Table = std::array<Colour8, 256>;

template <typename F>
Table table_of(F f) {
    Table table;
    for (int i = 0; i < 256; ++i) table[std::size_t(i)] = f(i / 255.0);
    return table;
}

Colour8 looked_up(const Table& table, float t) {
    return table[t > 0 ? std::size_t(std::min(t, 1.0f) * 255 + 0.5f) : 0];
}

}  // namespace

Colour8 heat_colour(float t) {
    static const Table table = table_of([](double x) {
        const double hue = (-75 + 180 * std::pow(x, 1.2)) * k_pi / 180;  // violet-blue to yellow through red
        return shown(0.13 + 0.85 * x, 0.03 + 0.2 * std::sin(k_pi * std::pow(x, 0.85)), hue);
    });
    return looked_up(table, t);
}

Colour8 signed_colour(float t) {
    static const Table table = table_of([](double x) {
        const double size = std::abs(2 * x - 1), hue = (x < 0.5 ? 255 : 30) * k_pi / 180;
        return shown(0.97 - 0.57 * size, 0.19 * std::pow(size, 0.8), hue);
    });
    return looked_up(table, t * 0.5f + 0.5f);
}

}  // namespace domelight
