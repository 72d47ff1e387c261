#include "texture/texel/rgba8_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {

namespace {

/// The value of a colour byte before it is scaled.
struct Square {
    static float linear(int byte) {
        const float share = float(byte) / 255;
        return share * share;
    }
    /// The byte whose value is `v`, not yet rounded. v from 0 to a little above 1.
    static float byte(float v) { return 255 * std::sqrt(v); }
};

/// Babylon's toLinearSpace and toGammaSpace, with its power of 2.2.
struct Gamma {
    static float linear(int byte) {
        static const std::array<float, 256> k_table = [] {
            std::array<float, 256> table;
            for (int i = 0; i < 256; ++i) table[std::size_t(i)] = float(std::pow(i / 255.0, 2.2));
            return table;
        }();
        return k_table[std::size_t(byte)];
    }
    static float byte(float v) { return 255 * std::pow(v, 1 / 2.2f); }
};

/// The factor on the colours for a scale byte, and the smallest scale whose factor reaches `largest`; larger scales lie
/// in direction k_step from there, none below k_least.
struct RgbmScale {
    static constexpr int k_step = 1, k_least = 1;
    static float factor(int scale) {
        const float f = 8 * float(scale) / 255;
        return f * f;
    }
    static int tightest(float largest) { return int(std::ceil(std::sqrt(largest) * (255.0f / 8))); }
};
struct RgbpScale {
    static constexpr int k_step = -1, k_least = 0;
    static float factor(int scale) {
        const float f = 8 - 7 * float(scale) / 255;
        return f * f;
    }
    static int tightest(float largest) { return int(std::floor((8 - std::sqrt(largest)) * (255.0f / 7))); }
};
struct RgbdScale {
    static constexpr int k_step = -1, k_least = 1;
    static float factor(int scale) { return 255 / float(std::max(scale, 1)); }
    static int tightest(float largest) { return int(std::floor(255 / std::max(largest, 1.0f))); }
};

template <typename Curve, typename Scale>
Rgba8 encode(const Vec3f& rgb) {
    const float channel[3] = {rgb.x, rgb.y, rgb.z}, largest = std::max({rgb.x, rgb.y, rgb.z});
    Rgba8 best{};
    float least = std::numeric_limits<float>::infinity();
    int scale = std::clamp(Scale::tightest(largest), Scale::k_least, 255);
    for (int i = 0; i < k_scales_tried && scale >= Scale::k_least && scale <= 255; ++i, scale += Scale::k_step) {
        const float factor = Scale::factor(scale);
        Rgba8 candidate{0, 0, 0, std::uint8_t(scale)};
        float error = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            // The nearest value belongs to one of the two neighbouring bytes, but not always to the nearer one.
            const int below = std::clamp(int(Curve::byte(channel[c] / factor)), 0, 255),
                      above = std::min(below + 1, 255);
            const float d0 = Curve::linear(below) * factor - channel[c],
                        d1 = Curve::linear(above) * factor - channel[c];
            const bool up = std::abs(d1) < std::abs(d0);
            candidate[c] = std::uint8_t(up ? above : below);
            error += up ? d1 * d1 : d0 * d0;
        }
        if (error < least) {
            least = error;
            best = candidate;
        }
        if (least == 0) break;
    }
    return best;
}

template <typename Curve, typename Scale>
Vec3f decode(const Rgba8& bytes) {
    const float factor = Scale::factor(bytes[3]);
    return {Curve::linear(bytes[0]) * factor, Curve::linear(bytes[1]) * factor, Curve::linear(bytes[2]) * factor};
}

}  // namespace

Rgba8 rgbm_from_rgb(const Vec3f& rgb) {
    return encode<Square, RgbmScale>(rgb);
}
Rgba8 rgbp_from_rgb(const Vec3f& rgb) {
    return encode<Square, RgbpScale>(rgb);
}
Rgba8 rgbd_from_rgb(const Vec3f& rgb) {
    return encode<Gamma, RgbdScale>(rgb);
}

Vec3f rgb_from_rgbm(const Rgba8& bytes) {
    return decode<Square, RgbmScale>(bytes);
}
Vec3f rgb_from_rgbp(const Rgba8& bytes) {
    return decode<Square, RgbpScale>(bytes);
}
Vec3f rgb_from_rgbd(const Rgba8& bytes) {
    return decode<Gamma, RgbdScale>(bytes);
}

}  // namespace domelight
