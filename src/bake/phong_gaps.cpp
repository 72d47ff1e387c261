#include "bake/phong_gaps.h"

#include "domelight/image/colour.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// Face size or height of the probes: fine enough to meet the edge of a softbox, and cheap beside a chain.
constexpr int k_probe_size = 32;

/// The exponent half way between two levels. By level numbers, as default_phong_level() has them, that is the geometric
/// mean; below 1, where exponents end at 0, the roughness of the matching lobe, (2 / (n + 2))^(1/4), takes their place.
double middle_exponent(double above, double below) {
    if (below >= 1) return std::sqrt(above * below);
    const auto roughness = [](double n) { return std::pow(2 / (n + 2), 0.25); };
    return 2 / std::pow((roughness(above) + roughness(below)) / 2, 4) - 2;
}

LevelSpec probe(Lobe lobe, double exponent) {
    return {k_probe_size, false, {lobe, exponent}};
}

/// |interpolated / own - 1| of the luminance, in each direction where there is light.
std::vector<double> reading_errors(const FilteredMap& above, const FilteredMap& own, const FilteredMap& below) {
    std::vector<double> errors;
    const auto a = above.pixels(), b = own.pixels(), c = below.pixels();
    for (std::size_t i = 0; i + 2 < b.size(); i += 3) {
        const double expected = luminance(&b[i]);
        const double read = (luminance(&a[i]) + luminance(&c[i])) / 2;
        if (expected > 0) errors.push_back(std::abs(read / expected - 1));
    }
    return errors;
}

}  // namespace

std::vector<LevelSpec> phong_gap_probes(std::span<const LevelPlan> chain) {
    std::vector<LevelSpec> probes;
    for (const LevelPlan& level : chain) {
        if (level.spec.mirror) continue;
        const Lobe lobe = level.spec.kernel.lobe;
        if (!probes.empty()) probes.push_back(probe(lobe, middle_exponent(probes.back().kernel.width, level.exponent)));
        probes.push_back(probe(lobe, level.exponent));
    }
    if (probes.size() < 3) probes.clear();
    return probes;
}

std::vector<PhongGap> phong_gaps(std::span<const LevelSpec> probes, std::span<const FilteredMap> maps) {
    std::vector<PhongGap> gaps;
    for (std::size_t i = 0; i + 2 < maps.size(); i += 2) {
        std::vector<double> errors = reading_errors(maps[i], maps[i + 1], maps[i + 2]);
        PhongGap gap{.exponent = probes[i + 1].kernel.width};
        if (!errors.empty()) {
            const auto middle = errors.begin() + std::ptrdiff_t(errors.size() / 2);
            std::nth_element(errors.begin(), middle, errors.end());
            gap.median_error = *middle;
            gap.worst_error = *std::max_element(middle, errors.end());
        }
        gaps.push_back(gap);
    }
    return gaps;
}

}  // namespace domelight
