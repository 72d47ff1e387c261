#include "filtering/filter_plan.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Degrees beyond this cost seconds; what they would add is stated in docs/math/prefilter.md.
constexpr int k_most_degrees = 3072;
constexpr int k_least_degrees = 256;
/// b L at the band limit L.
constexpr double k_decay = 16.6, k_decay_split = 11;
/// From here on a lobe counts as narrow.
constexpr int k_split_degrees = 600;

}  // namespace

int required_band_limit(const ZonalKernel& kernel, bool split) {
    switch (kernel.lobe) {
        case Lobe::ggx: {
            // The spectrum falls as b l K_1(b l). The clamp at the horizon adds a tail, alpha^2 l^-2.5.
            const double alpha = kernel.width, b = alpha < 1 ? 2 * alpha / std::sqrt(1 - alpha * alpha) : 1e9;
            return std::clamp(int(std::ceil((split ? k_decay_split : k_decay) / b)), alpha > 0.05 ? k_least_degrees : 64, k_most_degrees);
        }
        case Lobe::charlie: return kernel.width > 0.06 ? 768 : 1024;
        default:
            // cos^n ~ e^{-n theta^2 / 2}: the spectrum is e^{-l^2 / 2n}.
            return std::clamp(int(std::ceil(7 * std::sqrt(kernel.width + 1))), k_least_degrees, k_most_degrees);
    }
}

bool leaves_residual(const ZonalKernel& kernel) {
    switch (kernel.lobe) {
        case Lobe::ggx: return kernel.width > 0.1;
        case Lobe::charlie: return true;
        default: return kernel.width < 4;
    }
}

FilterPlan make_filter_plan(const FilterOptions& options) {
    struct Need {
        int level, band_limit;
    };
    FilterPlan plan;
    for (const LevelSpec& level : options.specular)
        plan.split |= !level.mirror && level.kernel.lobe == Lobe::ggx && required_band_limit(level.kernel, false) > k_split_degrees;
    std::vector<Need> needs;
    for (int l = 0; l < int(options.specular.size()); ++l)
        if (!options.specular[l].mirror) needs.push_back({l, required_band_limit(options.specular[l].kernel, plan.split)});
    if (options.irradiance_size > 0) needs.push_back({FilterPlan::k_irradiance, required_band_limit(ZonalKernel::cosine(), plan.split)});
    std::stable_sort(needs.begin(), needs.end(), [](const Need& a, const Need& b) { return a.band_limit > b.band_limit; });

    plan.band_limit = std::max(options.sh_bands - 1, 8);
    for (const Need& need : needs) {
        plan.band_limit = std::max(plan.band_limit, need.band_limit);
        const RingGrid grid = ring_grid_for(need.band_limit);
        if (plan.groups.empty() || plan.groups.back().grid != grid) plan.groups.push_back({need.band_limit, grid, {}});
        plan.groups.back().levels.push_back(need.level);
    }
    return plan;
}

}  // namespace domelight
