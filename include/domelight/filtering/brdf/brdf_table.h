#pragma once

#include "domelight/base/names.h"
#include "domelight/image/image.h"
#include "domelight/sampling/sequences.h"

namespace domelight {

/// Masking-shadowing used for the BRDF (DFG) table.
enum class BrdfG {
    correlated,  ///< height-correlated Smith (Heitz 2014, eq. 99): the default
    smith,       ///< separable Smith
    karis,       ///< Schlick's form of Smith's masking with k = alpha / 2 (Karis 2013)
};
template <>
struct EnumNames<BrdfG> {
    static constexpr const char* kind = "a masking function";
    static constexpr NamedValue<BrdfG> table[] = {
        {BrdfG::correlated, "correlated"},
        {BrdfG::smith, "smith"},
        {BrdfG::karis, "karis"},
    };
};

struct BrdfTableOptions {
    int size = 128;
    BrdfG g = BrdfG::correlated;
    int threads = 0;
};

/// The BRDF table: u = NdotV, v = roughness (row 0 is the smoothest), at texel centres (i + 1/2) / size. Its float
/// channels are
// clang-format off
///   0  scale    ∫ D Vis (1 - Fc) NdotL dl       so that the specular reflectance is F0 scale + bias,
///   1  bias     ∫ D Vis Fc NdotL dl             with Vis = G / (4 NdotL NdotV) and Fc = (1 - VdotH)^5
///   2  charlie  the directional albedo of the sheen lobe
// clang-format on
/// Computed by Gauss-Legendre quadrature (docs/math/prefilter.md) with an error of at most 1e-5.
ImageF brdf_table(const BrdfTableOptions& options = {});

/// The multiple-scattering form that Filament reads: (∫ D Vis Fc NdotL dl, ∫ D Vis NdotL dl) = (bias, scale + bias).
/// The third channel (sheen) is copied unchanged.
ImageF brdf_table_multiscatter(ImageView<const float> table);

/// The same table by Karis' IntegrateBRDF (2013), for comparison: a mean over GGX half vectors, drawn by the same
/// points for every texel.
ImageF brdf_table_montecarlo(const BrdfTableOptions& options, const PointSet& points);

/// The default table (128^2, correlated), computed when the library was built.
const ImageF& brdf_table_default();

}  // namespace domelight
