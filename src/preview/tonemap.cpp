#include "preview/tonemap.h"

#include "domelight/projection.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

float finite(float v) {
    return v >= 0 ? std::min(v, 1e30f) : 0;
}  // also takes NaN to 0

// Khronos PBR Neutral tone mapper specification, 2024: start of compression 0.8 - F90, desaturation 0.15.
Vec3f neutral(Vec3f v) {
    constexpr float start = 0.8f - 0.04f, desaturation = 0.15f;
    const float least = std::min({v.x, v.y, v.z});
    const float offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
    v = v - Vec3f{offset, offset, offset};
    const float peak = std::max({v.x, v.y, v.z});
    if (peak < start) return v;
    constexpr float d = 1 - start;
    const float new_peak = 1 - d * d / (peak + d - start);
    v = v * (new_peak / peak);
    const float g = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    return v * (1 - g) + Vec3f{new_peak, new_peak, new_peak} * g;
}

// AgX's base contrast. Matrices and log2 range as in Blender's configuration, the curve by B. Wrensch's polynomial of
// the sixth degree.
Vec3f agx(const Vec3f& v) {
    constexpr float least_ev = -12.47393f, most_ev = 4.026069f;
    const auto curve = [](float linear) {
        const float x = std::clamp((std::log2(std::max(linear, 1e-10f)) - least_ev) / (most_ev - least_ev), 0.0f, 1.0f);
        const float x2 = x * x, x4 = x2 * x2;
        return 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x -
               0.00232f;
    };
    const Vec3f in{curve(0.842479062f * v.x + 0.0784336f * v.y + 0.0792237451f * v.z),
                   curve(0.0423282422f * v.x + 0.878468636f * v.y + 0.0791661275f * v.z),
                   curve(0.0423756549f * v.x + 0.0784336f * v.y + 0.879142974f * v.z)};
    const auto linear = [](float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 2.2f); };
    return {linear(1.196879005f * in.x - 0.0980208811f * in.y - 0.0990297441f * in.z),
            linear(-0.0528968518f * in.x + 1.15190313f * in.y - 0.0989611768f * in.z),
            linear(-0.0529716355f * in.x - 0.0980434501f * in.y + 1.15107367f * in.z)};
}

/// Linear values at which the 8-bit code steps from i to i + 1.
const std::array<float, 255>& srgb_steps() {
    static const auto steps = [] {
        std::array<float, 255> s{};
        for (int i = 0; i < 255; ++i) {
            const double code = (i + 0.5) / 255;
            s[i] = float(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
        }
        return s;
    }();
    return steps;
}

/// For each of 4096 equal steps of the linear value, the code at its start; at most a few steps of srgb_steps are in
/// each.
const std::array<std::uint8_t, 4097>& srgb_table() {
    static const auto table = [] {
        std::array<std::uint8_t, 4097> t{};
        const auto& steps = srgb_steps();
        for (int i = 0; i <= 4096; ++i)
            t[i] = std::uint8_t(std::upper_bound(steps.begin(), steps.end(), float(i) / 4096) - steps.begin());
        return t;
    }();
    return table;
}

}  // namespace

Vec3f tonemap(const Vec3f& rgb, Tonemap method) {
    Vec3f v{finite(rgb.x), finite(rgb.y), finite(rgb.z)};
    if (method == Tonemap::neutral) v = neutral(v);
    if (method == Tonemap::agx) v = agx(v);
    return {std::clamp(v.x, 0.0f, 1.0f), std::clamp(v.y, 0.0f, 1.0f), std::clamp(v.z, 0.0f, 1.0f)};
}

std::uint8_t srgb8(float linear) {
    const float v = std::clamp(finite(linear), 0.0f, 1.0f);
    int code = srgb_table()[int(v * 4096)];
    const auto& steps = srgb_steps();
    while (code < 255 && v >= steps[code]) ++code;
    return std::uint8_t(code);
}

std::array<std::uint8_t, 3> display_rgb8(const Vec3f& radiance, float exposure, Tonemap method) {
    const Vec3f v = tonemap(radiance * exposure, method);
    return {srgb8(v.x), srgb8(v.y), srgb8(v.z)};
}

double log_average_luminance(ImageView<const float> image) {
    // Texels, not averages, are looked at, so that a sun stays a few of them.
    const int step_x = std::max(1, image.width / 512), step_y = std::max(1, image.height / 256);
    std::vector<float> values;
    std::vector<double> weights;
    double mean = 0, weight = 0;
    for (int y = step_y / 2; y < image.height; y += step_y) {
        const double w = latlong_solid_angle(y, image.width, image.height);
        for (int x = step_x / 2; x < image.width; x += step_x) {
            const float* p = image.at(x, y);
            const float l = finite(luminance({p[0], p[1], p[2]}));
            values.push_back(l);
            weights.push_back(w);
            mean += w * l;
            weight += w;
        }
    }
    if (!(mean > 0)) return 0;
    const double floor = 1e-3 * mean / weight;
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights[i] * std::log(std::max(double(values[i]), floor));
    return std::exp(sum / weight);
}

}  // namespace domelight
