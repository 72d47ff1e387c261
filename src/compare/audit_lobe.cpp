#include "compare/audit_lobe.h"

#include <cmath>
#include <limits>

namespace domelight {

double roughness_of_exponent(double exponent) {
    return std::isinf(exponent) ? 0 : std::pow(2 * exponent + 1, -0.25);
}

double exponent_of_roughness(double roughness) {
    if (roughness <= 0) return std::numeric_limits<double>::infinity();
    return 0.5 * (std::pow(roughness, -4) - 1);
}

ZonalKernel lobe_at_roughness(Lobe lobe, double roughness) {
    return {lobe, is_phong(lobe) ? exponent_of_roughness(roughness) : roughness * roughness};
}

bool starts_at_mirror(Lobe lobe) {
    return lobe != Lobe::charlie;
}

}  // namespace domelight
