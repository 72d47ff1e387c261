#include "preview/tonemap.h"

#include "domelight/projection.h"

#include <algorithm>
#include <bit>
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

// AgX: into its primaries, a contrast curve over log2, a look, and out again to a display of gamma 2.2. Matrices and
// range as in Blender's configuration, the curve by B. Wrensch's polynomial of the sixth degree; the punchy look is a
// power of 1.35 and a saturation of 1.4.
constexpr float k_agx_least_ev = -12.47393f, k_agx_most_ev = 4.026069f;

float agx_curve(float linear, bool punchy) {
    const float ev = std::log2(std::max(linear, 1e-10f));
    const float x = std::clamp((ev - k_agx_least_ev) / (k_agx_most_ev - k_agx_least_ev), 0.0f, 1.0f);
    const float x2 = x * x, x4 = x2 * x2;
    const float y =
        15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x - 0.00232f;
    return punchy ? std::pow(std::max(y, 0.0f), 1.35f) : y;
}

Vec3f agx_inset(const Vec3f& v) {
    return {0.842479062f * v.x + 0.0784336f * v.y + 0.0792237451f * v.z,
            0.0423282422f * v.x + 0.878468636f * v.y + 0.0791661275f * v.z,
            0.0423756549f * v.x + 0.0784336f * v.y + 0.879142974f * v.z};
}

/// From the curve's values to display values of gamma 2.2, 0..1.
Vec3f agx_outset(Vec3f v, bool punchy) {
    if (punchy) {
        const float grey = luminance(v);
        v = Vec3f{grey, grey, grey} + (v - Vec3f{grey, grey, grey}) * 1.4f;
    }
    return {std::clamp(1.196879005f * v.x - 0.0980208811f * v.y - 0.0990297441f * v.z, 0.0f, 1.0f),
            std::clamp(-0.0528968518f * v.x + 1.15190313f * v.y - 0.0989611768f * v.z, 0.0f, 1.0f),
            std::clamp(-0.0529716355f * v.x - 0.0980434501f * v.y + 1.15107367f * v.z, 0.0f, 1.0f)};
}

/// A function of 0..1 in 4096 straight pieces.
class UnitTable {
  public:
    template <typename F>
    explicit UnitTable(F f) {
        for (int i = 0; i <= k_pieces; ++i) values_[i] = f(float(i) / k_pieces);
        values_[k_pieces + 1] = values_[k_pieces];
    }
    float operator()(float x) const {
        const float at = x * k_pieces;
        const int i = int(at);
        return values_[i] + (values_[i + 1] - values_[i]) * (at - float(i));
    }

  private:
    static constexpr int k_pieces = 4096;
    std::array<float, k_pieces + 2> values_{};
};

/// agx_curve in 64 straight pieces to each power of two, found from a float's bits.
class CurveTable {
  public:
    explicit CurveTable(bool punchy) {
        for (std::uint32_t i = 0; i < values_.size(); ++i)
            values_[i] = agx_curve(std::bit_cast<float>(k_first + (i << k_shift)), punchy);
    }
    float operator()(float x) const {
        const float inside = std::clamp(x, std::bit_cast<float>(k_first), 31.99f);
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(inside) - k_first, i = bits >> k_shift;
        const float f = float(bits & ((1u << k_shift) - 1)) / float(1u << k_shift);
        return values_[i] + (values_[i + 1] - values_[i]) * f;
    }

  private:
    static constexpr int k_shift = 17;                    // keeps 6 of the mantissa's bits
    static constexpr std::uint32_t k_first = 114u << 23;  // 2^-13
    std::array<float, (18 << 6) + 1> values_{};           // up to 2^5
};

}  // namespace

Vec3f tonemap(const Vec3f& rgb, Tonemap method) {
    const Vec3f v{finite(rgb.x), finite(rgb.y), finite(rgb.z)};
    if (method == Tonemap::agx || method == Tonemap::agx_punchy) {
        const bool punchy = method == Tonemap::agx_punchy;
        const Vec3f in = agx_inset(v);
        const Vec3f out =
            agx_outset({agx_curve(in.x, punchy), agx_curve(in.y, punchy), agx_curve(in.z, punchy)}, punchy);
        return {std::pow(out.x, 2.2f), std::pow(out.y, 2.2f), std::pow(out.z, 2.2f)};
    }
    const Vec3f out = method == Tonemap::neutral ? neutral(v) : v;
    return {std::clamp(out.x, 0.0f, 1.0f), std::clamp(out.y, 0.0f, 1.0f), std::clamp(out.z, 0.0f, 1.0f)};
}

float srgb_encode(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

Vec3f Display::encoded(const Vec3f& radiance) const {
    static const UnitTable from_linear(srgb_encode), from_gamma([](float v) { return srgb_encode(std::pow(v, 2.2f)); });
    static const CurveTable plain(false), punchy(true);
    const Vec3f rgb = radiance * exposure_, v{finite(rgb.x), finite(rgb.y), finite(rgb.z)};
    if (method_ == Tonemap::agx || method_ == Tonemap::agx_punchy) {
        const bool look = method_ == Tonemap::agx_punchy;
        const CurveTable& curve = look ? punchy : plain;
        const Vec3f in = agx_inset(v), out = agx_outset({curve(in.x), curve(in.y), curve(in.z)}, look);
        return {from_gamma(out.x), from_gamma(out.y), from_gamma(out.z)};
    }
    const Vec3f out = tonemap(v, method_);
    return {from_linear(out.x), from_linear(out.y), from_linear(out.z)};
}

std::array<std::uint8_t, 3> Display::rgb8(const Vec3f& radiance) const {
    const Vec3f v = encoded(radiance);
    return {to_byte(v.x), to_byte(v.y), to_byte(v.z)};
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
