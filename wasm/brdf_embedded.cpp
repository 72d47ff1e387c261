#include "filtering/brdf/brdf_embedded.h"

#include "filtering/brdf/brdf_quadrature.h"

namespace domelight {

/// Computed at the first call: the table would add 180 kilobytes to the module.
ImageF embedded_brdf_table() {
    return integrate_brdf_table(k_brdf_embedded_size, BrdfG::correlated, true, 1);
}

}  // namespace domelight
