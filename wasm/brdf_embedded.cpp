#include "filtering/brdf/brdf_embedded.h"

#include "filtering/brdf/brdf_quadrature.h"

namespace domelight {

/// Computed at the first call: the table would add 180 kilobytes to the module.
ImageF embedded_brdf_table() {
    constexpr int size = k_brdf_embedded_size;
    ImageF image(size, size, 3);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double NdotV = (x + 0.5) / size, roughness = (y + 0.5) / size, alpha = roughness * roughness;
            const BrdfTerms terms = integrate_brdf(NdotV, alpha, BrdfG::correlated);
            float* texel = image.at(x, y);
            texel[0] = float(terms.scale), texel[1] = float(terms.bias), texel[2] = float(integrate_sheen(NdotV, alpha));
        }
    return image;
}

}  // namespace domelight
