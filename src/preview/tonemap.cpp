#include "preview/tonemap.h"

#include "domelight/projection/projection.h"

#include "preview/agx.h"

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
    v *= (new_peak / peak);
    const float g = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    return v * (1 - g) + Vec3f{new_peak, new_peak, new_peak} * g;
}

/// ACES 1.0's reference rendering and sRGB output transforms (RRT + ODT), by S. Hill's fit: into a desaturated AP1, one
/// rational curve a channel, and back to Rec. 709. Middle grey 0.18 becomes 0.106, as dark as in the original.
Vec3f aces(const Vec3f& v) {
    const auto curve = [](float x) {
        return (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
    };
    // The curve tends to 1 / 0.983729; beyond this, squares would leave float's range.
    const auto bounded = [&](float x) { return curve(std::min(x, 1e15f)); };
    const float r = bounded(0.59719f * v.x + 0.35458f * v.y + 0.04823f * v.z),
                g = bounded(0.07600f * v.x + 0.90834f * v.y + 0.01566f * v.z),
                b = bounded(0.02840f * v.x + 0.13383f * v.y + 0.83777f * v.z);
    return {1.60475f * r - 0.53108f * g - 0.07367f * b, -0.10208f * r + 1.10813f * g - 0.00605f * b,
            -0.00327f * r - 0.07276f * g + 1.07602f * b};
}

/// Reinhard et al. 2002, eq. 4, on luminance, so that hue and saturation stay: L (1 + L / white^2) / (1 + L). The
/// luminance `white` becomes 1. The paper uses the largest luminance of the picture, but then the pictures of a series
/// would not be comparable.
Vec3f reinhard(const Vec3f& v) {
    constexpr float white = k_reinhard_white;
    const float l = luminance(v);
    return v * ((1 + l / (white * white)) / (1 + l));
}

}  // namespace

Vec3f tonemap(const Vec3f& rgb, Tonemap method) {
    const Vec3f v{finite(rgb.x), finite(rgb.y), finite(rgb.z)};
    if (method == Tonemap::agx || method == Tonemap::agx_punchy) {
        const bool punchy = method == Tonemap::agx_punchy;
        const Vec3f in = agx_inset(v);
        const Vec3f out =
            agx_outset({agx_curve(in.x, punchy), agx_curve(in.y, punchy), agx_curve(in.z, punchy)}, punchy);
        const auto linear = [](float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 2.2f); };
        return {linear(out.x), linear(out.y), linear(out.z)};
    }
    const Vec3f out = method == Tonemap::neutral    ? neutral(v)
                      : method == Tonemap::aces     ? aces(v)
                      : method == Tonemap::reinhard ? reinhard(v)
                                                    : v;
    return {std::clamp(out.x, 0.0f, 1.0f), std::clamp(out.y, 0.0f, 1.0f), std::clamp(out.z, 0.0f, 1.0f)};
}

float srgb_encode(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

double log_average_luminance(ImageView<const float> image) {
    // Single texels are used, not averages, so that a sun remains a few of them.
    const int step_x = std::max(1, image.width / 512), step_y = std::max(1, image.height / 256);
    std::vector<float> values;
    std::vector<double> weights;
    double mean = 0, weight = 0;
    for (int y = step_y / 2; y < image.height; y += step_y) {
        const double w = latlong_solid_angle(y, image.width, image.height);
        for (int x = step_x / 2; x < image.width; x += step_x) {
            const float* p = image.at(x, y);
            const float l = finite(luminance(Vec3f{p[0], p[1], p[2]}));
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
