#include "filtering/filter_plan.h"

#include "base/sort.h"
#include "filtering/direct/direct_sums.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Higher degrees would cost seconds; docs/math/prefilter.md states what they would add.
constexpr int k_most_degrees = 3072;
/// b L at the band limit L, if the brightest texels are removed.
constexpr double k_decay_split = 11;
/// Lobes below this width count as narrow: a sun is then 10^6 times as bright as its dark surroundings, and the
/// rounding of float expansions matters.
constexpr int k_split_degrees = 600;
constexpr double k_split_exponent = 500;

}  // namespace

int least_degrees(int face_size) {
    return std::clamp(2 * face_size, 128, k_least_degrees);
}

int required_band_limit(const ZonalKernel& kernel, bool split, const DegreeLimits& degrees) {
    switch (kernel.lobe) {
        case Lobe::ggx: {
            // The spectrum falls as b l K_1(b l). The clamp at the horizon adds a tail, alpha^2 l^-2.5.
            const double alpha = kernel.width, b = alpha < 1 ? 2 * alpha / std::sqrt(1 - alpha * alpha) : 1e9;
            return std::clamp(int(std::ceil((split ? k_decay_split : degrees.decay) / b)),
                              alpha > 0.05 ? degrees.least : 64, k_most_degrees);
        }
        case Lobe::charlie:
            return kernel.width > 0.06 ? 768 : 1024;
        default:
            // cos^n ~ e^{-n theta^2 / 2}: the spectrum is e^{-l^2 / 2n}.
            return std::clamp(int(std::ceil(7 * std::sqrt(kernel.width + 1))), degrees.least, k_most_degrees);
    }
}

bool leaves_residual(const ZonalKernel& kernel) {
    switch (kernel.lobe) {
        case Lobe::ggx:
            return kernel.width > 0.1;
        case Lobe::charlie:
            return true;
        default:
            return kernel.width < 4;
    }
}

namespace {

bool is_narrow(const ZonalKernel& kernel) {
    switch (kernel.lobe) {
        case Lobe::ggx:
            return required_band_limit(kernel, false) > k_split_degrees;
        case Lobe::charlie:
            return false;
        default:
            return kernel.width > k_split_exponent;
    }
}

}  // namespace

FilterPlan make_filter_plan(const FilterOptions& options, bool sums_directly, const DegreeLimits& degrees) {
    struct Need {
        int level, band_limit;
        bool narrow;
    };
    std::vector<Need> needs;
    const auto add = [&](int level, const ZonalKernel& kernel) {
        const bool narrow = is_narrow(kernel);
        needs.push_back({level, required_band_limit(kernel, narrow, degrees), narrow});
    };
    FilterPlan plan;
    for (int l = 0; l < int(options.specular.size()); ++l) {
        const LevelSpec& level = options.specular[l];
        if (level.mirror) continue;
        if (sums_directly && is_narrow(level.kernel) && DirectSums::takes_directly(level, options.layout))
            plan.direct.push_back(l);
        else
            add(l, level.kernel);
    }
    plan.split = !plan.direct.empty();
    if (options.irradiance_size > 0) add(FilterPlan::k_irradiance, ZonalKernel::cosine());
    sort_stably(needs, [](const Need& a, const Need& b) {
        return std::pair(a.narrow, a.band_limit) > std::pair(b.narrow, b.band_limit);
    });

    // The interpolation between rows and rings assumes spectra that have decayed at the band limit. Coefficients that
    // are themselves a result must therefore lie in its first third.
    plan.wide_band_limit = std::max(64, 3 * (options.sh_bands - 1));
    plan.band_limit = plan.wide_band_limit;
    for (const Need& need : needs) {
        plan.band_limit = std::max(plan.band_limit, need.band_limit);
        if (!need.narrow) plan.wide_band_limit = std::max(plan.wide_band_limit, need.band_limit);
        plan.split |= need.narrow;
        const RingGrid grid = ring_grid_for(need.band_limit);
        if (plan.groups.empty() || plan.groups.back().grid != grid || plan.groups.back().narrow != need.narrow)
            plan.groups.push_back({need.band_limit, grid, need.narrow, {}});
        plan.groups.back().levels.push_back(need.level);
    }
    return plan;
}

}  // namespace domelight
