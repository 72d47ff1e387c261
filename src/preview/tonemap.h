#pragma once

#include "domelight/base/names.h"
#include "domelight/base/vec.h"
#include "domelight/image/colour.h"
#include "domelight/image/image.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace domelight {

/// The mapping from radiance to a colour that a display can show.
enum class Tonemap {
    none,     ///< clipped
    neutral,  ///< Khronos PBR Neutral (2024): colours below 0.8 as they are, highlights rolled off without a change of
              ///< hue
    agx,      ///< AgX (Sobotka 2022), by Wrensch's polynomial: a film's contrast, bright colours towards white
    agx_punchy,  ///< AgX with its "punchy" look: more contrast and saturation
    aces,        ///< ACES 1.0's RRT and sRGB ODT, by Hill's fit (2016)
    reinhard,    ///< Reinhard et al. 2002, eq. 4, on luminance: `k_reinhard_white` becomes white
    gamma22,     ///< clipped, and encoded by the power 1 / 2.2 instead of the sRGB curve
};
template <>
struct EnumNames<Tonemap> {
    static constexpr const char* kind = "a tone map";
    static constexpr NamedValue<Tonemap> table[] = {
        {Tonemap::agx, "agx"},   {Tonemap::agx_punchy, "agx-punchy"}, {Tonemap::neutral, "neutral"},
        {Tonemap::aces, "aces"}, {Tonemap::reinhard, "reinhard"},     {Tonemap::gamma22, "gamma22"},
        {Tonemap::none, "none"},
    };
};

/// The luminance that `reinhard` makes white.
inline constexpr float k_reinhard_white = 4;

/// Tone maps linear Rec. 709 (already exposed); the result is display-linear Rec. 709 in 0..1. NaN gives 0.
Vec3f tonemap(const Vec3f& rgb, Tonemap method);

/// The sRGB transfer function (IEC 61966-2-1) of 0..1.
float srgb_encode(float linear);
/// Its inverse.
float srgb_decode(float encoded);

/// 0..1 to 0..255, rounded.
inline std::uint8_t to_byte(float v) {
    return std::uint8_t(v * 255 + 0.5f);
}

/// Exposure, tone map and the display's curve.
struct Display {
    Tonemap method = Tonemap::agx;
    float exposure = 1;
    /// Display values, 0..1.
    Vec3f encoded(const Vec3f& radiance) const {
        const Vec3f c = tonemap(radiance * exposure, method);
        return {curve(c.x), curve(c.y), curve(c.z)};
    }
    /// Of display-linear 0..1: sRGB's, or gamma22's own.
    float curve(float linear) const {
        return method == Tonemap::gamma22 ? std::pow(linear, 1 / 2.2f) : srgb_encode(linear);
    }
    std::array<std::uint8_t, 3> rgb8(const Vec3f& radiance) const {
        const Vec3f c = encoded(radiance);
        return {to_byte(c.x), to_byte(c.y), to_byte(c.z)};
    }
};

/// Log-average luminance of a lat-long image (3 channels) over solid angle (Reinhard et al. 2002, eq. 1), where
/// luminances below a thousandth of the mean are raised to it, so that black surroundings do not dominate. 0 for a
/// black image. At most about 512 x 256 of the texels are read.
double log_average_luminance(ImageView<const float> latlong);

}  // namespace domelight
