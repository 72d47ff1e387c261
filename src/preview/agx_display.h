#pragma once

#include "preview/texel4.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// Exposure, the punchy AgX tone map and the sRGB transfer function, to 8 bits, by tables: within one code of
/// srgb_encode(tonemap(exposure * radiance, Tonemap::agx_punchy)) at a fortieth of its cost. It has two halves, because
/// the first one is linear and can be applied once to each texel before interpolation.
class AgxDisplay {
  public:
    explicit AgxDisplay(float exposure);
    float exposure() const { return exposure_; }

    /// The first half: radiance (three values; negative ones and NaN count as 0) to exposed AgX primaries.
    Texel4 primaries(const Texel4& radiance) const;
    /// The second half: to red, green and blue in the lowest three bytes, red the lowest.
    std::uint32_t code(const Texel4& primaries) const {
        using V = Texel4::Vector;
        const V low = Texel4::all(k_least).v, high = Texel4::all(k_most).v;
        V x = primaries.v;
        x = x < low ? low : x;
        x = x > high ? high : x;
        Texel4::Integers at;
        __builtin_memcpy(&at, &x, sizeof at);
        at = (at - k_first) >> k_shift;
        const V y = curve_[at[0]] * column_[0].v + curve_[at[1]] * column_[1].v + curve_[at[2]] * column_[2].v;
        const V zero = Texel4::all(0).v, one = Texel4::all(1).v;
        V out = y < zero ? zero : y;
        out = (out > one ? one : out) * float(k_codes - 1) + 0.5f;
        const auto i = __builtin_convertvector(out, Texel4::Integers);
        return std::uint32_t(codes_[i[0]]) | std::uint32_t(codes_[i[1]]) << 8 | std::uint32_t(codes_[i[2]]) << 16;
    }

  private:
    static constexpr int k_shift = 15;                  // keeps 8 of the mantissa's bits
    static constexpr std::int32_t k_first = 114 << 23;  // the bits of 2^-13
    static constexpr float k_least = 0x1p-13f, k_most = 31.99f;
    static constexpr int k_codes = 4096;

    float exposure_;
    Texel4 inset_[3], column_[3];  ///< columns of matrices
    std::vector<float> curve_;     ///< by a float's upper bits
    std::vector<std::uint8_t> codes_;
};

}  // namespace domelight
