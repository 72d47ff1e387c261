#pragma once

#include "domelight/base/vec.h"
#include "domelight/texture/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace domelight {

/// The effect of storing a run of texels, as weighted sums (weights: solid angle up to a factor; luminance: Rec. 709).
struct EncodeSums {
    std::int64_t clipped = 0;  ///< texels with a channel outside the encoding's range
    double power = 0;          ///< sum w L(v)
    double lost = 0;           ///< sum w L(v - clipped v), of channels above the range
    double error = 0;          ///< sum w |stored - v|^2 over texels that were not clipped
    double norm = 0;           ///< sum w |v|^2 over the same; 0 for encodings that keep every float
    double log_error = 0;      ///< sum w |log2(stored + f) - log2(v + f)|^2 over the same; f: LogScale's
    double log_norm = 0;       ///< sum w over the same and over channels

    /// One texel: as read, clipped to the encoding's range, and as it will be decoded.
    void add(const Vec3f& read, const Vec3f& inside, const Vec3f& stored, double weight, float log_floor);

    void operator+=(const EncodeSums& b) {
        clipped += b.clipped;
        power += b.power;
        lost += b.lost;
        error += b.error;
        norm += b.norm;
        log_error += b.log_error;
        log_norm += b.log_norm;
    }
};

/// The scale on which logarithms of radiance are compared over one level.
struct LogScale {
    float floor = 1;   ///< added before the logarithm: 1e-4 of the mean luminance (1 where all is black)
    double range = 0;  ///< of log2(channel + floor), channels below 0 counting as 0
};
LogScale log_scale_of(std::span<const float> rgb);

/// The same of texels that come in pieces. The result does not depend on where the pieces end.
class LogScaleSums {
  public:
    void add(std::span<const float> rgb);
    /// After the last piece.
    LogScale scale();

  private:
    static constexpr std::size_t k_chunk = 3 * 512;  ///< floats that are added in single precision
    void add_chunk(std::span<const float> rgb);

    std::array<double, 3> sum_{};
    float low_ = std::numeric_limits<float>::max(), high_ = 0;
    std::size_t count_ = 0;             ///< floats in all
    std::array<float, k_chunk> begun_;  ///< the chunk that is not complete yet
    std::size_t begun_count_ = 0;
};

/// NaN becomes 0.
inline float limit_to(float v, float low, float high) {
    if (v != v) return 0;
    return v < low ? low : v > high ? high : v;
}

inline void EncodeSums::add(const Vec3f& read, const Vec3f& inside, const Vec3f& stored, double weight,
                            float log_floor) {
    constexpr Vec3d k_luminance{0.2126, 0.7152, 0.0722};
    const auto number = [](float v) { return v == v ? v : 0.0f; };
    const Vec3d v = Vec3d(Vec3f{number(read.x), number(read.y), number(read.z)});
    power += weight * dot(k_luminance, v);
    if (!(read == inside)) {
        ++clipped;
        const Vec3d above = v - Vec3d(inside);
        lost +=
            weight * dot(k_luminance, Vec3d{std::max(above.x, 0.0), std::max(above.y, 0.0), std::max(above.z, 0.0)});
    } else {
        const Vec3d difference = Vec3d(stored) - v;
        error += weight * dot(difference, difference);
        norm += weight * dot(v, v);
        const auto ratio = [&](float now, float before) {
            if (now == before) return 0.0f;
            const float l = std::log2((std::max(now, 0.0f) + log_floor) / (std::max(before, 0.0f) + log_floor));
            return l * l;
        };
        log_error += weight * (ratio(stored.x, inside.x) + ratio(stored.y, inside.y) + ratio(stored.z, inside.z));
        log_norm += 3 * weight;
    }
}

/// Encodes `count` RGB float texels into `out` (count * encoding_bytes(encoding) bytes) and adds to the sums; `weight`
/// has one entry a texel. For encodings of single texels; block_codec.h has the others. Alpha is 1; two-channel
/// encodings take red and green. NaN is stored as 0.
EncodeSums encode_row_scalar(Encoding encoding, const float* rgb, int count, const float* weight, float log_floor,
                             std::uint8_t* out);

/// The sums alone, of texels that come back as `stored` from an encoding of channels from `low` to `high`.
EncodeSums compare_row_scalar(const float* rgb, const float* stored, int count, const float* weight, float low,
                              float high, float log_floor);

/// The same from one to three interleaved channels (missing ones are 0), without sums.
void encode_texels(Encoding encoding, const float* texels, int channels, int count, std::uint8_t* out);

/// Float texels of `count` encoded ones: RGB, or RG for two-channel encodings.
void decode_texels(Encoding encoding, const std::uint8_t* texels, int count, float* out);

}  // namespace domelight
