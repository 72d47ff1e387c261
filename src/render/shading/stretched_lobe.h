#pragma once
// The reflection lobe at grazing angles as a row of round lobes. docs/math/split-sum.md, "One step beyond".

#include <array>
#include <cstddef>

namespace domelight {

/// The number of lookups for each pixel, all in the prefiltered chain: that of split-sum and eight more.
inline constexpr int k_stretched_taps = 9;

/// One lookup: a lobe of the prefilter that represents a part of the true one.
struct StretchedTap {
    double tilt = 0;             ///< radians from the mirror direction towards the normal, in the plane of incidence
    double roughness = 0;        ///< of the chain's level, [0, 1]
    double scale = 0, bias = 0;  ///< weights for the parts of the lobe that are multiplied by F0 and by F90; each sums
                                 ///< to 1 over the taps
};

/// The lookups for a view, smooth in NdotV and roughness, both in [0, 1]. At NdotV = 1 the lobe is round, and all
/// lookups are in the mirror direction.
///
/// Polynomials of third degree in sqrt(NdotV) and fourth in roughness, fitted so that the row of lobes is nearest to D
/// G2 / (4 NdotV), with and without (1 - VdotH)^5, under environments of a natural spectrum
/// (docs/figures/stretched_fit.py). No tables: a shader evaluates nine vec4 polynomials.
std::array<StretchedTap, k_stretched_taps> stretched_taps(double NdotV, double roughness);

/// The coefficients: [tap][tilt, roughness, scale, bias][5 i + j] of NdotV^(i/2) roughness^j.
inline constexpr int k_stretched_cosines = 4, k_stretched_roughnesses = 5;
extern const float k_stretched_fit[k_stretched_taps][4][k_stretched_cosines * k_stretched_roughnesses];

}  // namespace domelight
