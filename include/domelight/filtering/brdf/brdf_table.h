#pragma once

#include "domelight/image/image.h"

namespace domelight {

/// Masking-shadowing used for the BRDF (DFG) table.
enum class BrdfG {
    correlated,  ///< height-correlated Smith (Heitz 2014, eq. 99): the default
    smith,       ///< separable Smith
    karis,       ///< the courses' Schlick form with k = alpha / 2 (Karis 2013)
};

struct BrdfTableOptions {
    int size = 128;
    BrdfG g = BrdfG::correlated;
    int threads = 0;
};

/// Channels of the table, each float; u = NdotV, v = roughness (row 0 is the smoothest), at texel centres (i + 1/2) /
/// size.
///   0  scale: int D G Vis (1 - Fc) NdotL dl     1  bias: int ... Fc ...     (specular reflectance = F0 scale + bias)
///   2  charlie: directional albedo of the sheen lobe
/// with Fc = (1 - VdotH)^5. By Gauss-Legendre quadrature (docs/math/prefilter.md), maximum error <= 1e-5.
ImageF brdf_table(const BrdfTableOptions& options = {});

/// The multiple-scattering form that Filament reads: (int Fc ..., int ...) = (bias, scale + bias), third channel as
/// above.
ImageF brdf_table_multiscatter(ImageView<const float> table);

/// The split-sum's integrateBRDF as the courses have it: Hammersley points and GGX half vectors (Karis 2013), for
/// comparison.
ImageF brdf_table_montecarlo(const BrdfTableOptions& options, int samples);

/// The default table (128^2, correlated), computed when the library was built.
const ImageF& brdf_table_default();

}  // namespace domelight
