#include "texture/texel/rgba8_ranges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace domelight {

namespace {

/// The value of a colour byte before it is scaled.
struct Square {
    static float linear(int byte) {
        const float share = float(byte) / 255;
        return share * share;
    }
    /// The byte whose value is `v`, rounded down; may be beyond 255. v from 0 to a little above 1.
    static int byte(float v) { return int(255 * std::sqrt(v)); }
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
    static int byte(float v) { return InverseGamma::made().byte(v); }

  private:
    /// Babylon's toGammaSpace rounded down to bytes, by a table: a power takes longer than all the rest of a texel.
    class InverseGamma {
      public:
        static const InverseGamma& made() {
            static const InverseGamma table;
            return table;
        }
        int byte(float v) const {
            if (v >= 1) return 255;
            if (v < k_least) return 0;
            int byte = first_[bucket(v)];
            while (v >= begin_[std::size_t(byte) + 1]) ++byte;
            return byte;
        }

      private:
        static constexpr float k_least = 0x1p-18f;  // less than byte 1 begins with
        static constexpr int k_bucket_bits = 17;    // 64 buckets between powers of two
        static std::size_t bucket(float v) {
            return (std::bit_cast<std::uint32_t>(v) - std::bit_cast<std::uint32_t>(k_least)) >> k_bucket_bits;
        }
        static bool reaches(float v, int byte) { return 255 * std::pow(v, 1 / 2.2f) >= float(byte); }

        InverseGamma() {
            begin_[256] = std::numeric_limits<float>::infinity();
            for (int byte = 1; byte < 256; ++byte) {
                std::uint32_t below = 0, at = std::bit_cast<std::uint32_t>(1.0f);
                while (at - below > 1) {
                    const std::uint32_t middle = (below + at) / 2;
                    (reaches(std::bit_cast<float>(middle), byte) ? at : below) = middle;
                }
                begin_[std::size_t(byte)] = std::bit_cast<float>(at);
            }
            for (std::size_t i = 0; i < first_.size(); ++i) {
                const float start =
                    std::bit_cast<float>(std::bit_cast<std::uint32_t>(k_least) + (std::uint32_t(i) << k_bucket_bits));
                int byte = 0;
                while (start >= begin_[std::size_t(byte) + 1]) ++byte;
                first_[i] = std::uint8_t(byte);
            }
        }

        std::array<float, 257> begin_{};           ///< the least value of each byte
        std::array<std::uint8_t, 18 * 64> first_;  ///< the byte of each bucket's least value
    };
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
            const int below = std::clamp(Curve::byte(channel[c] / factor), 0, 255), above = std::min(below + 1, 255);
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
