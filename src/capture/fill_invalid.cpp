#include "domelight/base/parallel.h"
#include "domelight/capture/placement.h"

#include "capture/surroundings.h"

#include <algorithm>

namespace domelight {
namespace {

/// How many of the nearest valid probes are looked at, and how many surfaces are told apart.
constexpr std::size_t k_candidates = 64;
constexpr int k_most_surfaces = 8;

/// The valid probes nearest to a point, the nearest first; equally near ones in the order of their numbers.
std::vector<int> nearest_valid(std::span<const Probe> probes, const Vec3f& point) {
    std::vector<std::pair<float, int>> found;
    for (std::size_t i = 0; i < probes.size(); ++i)
        if (probes[i].valid) found.push_back({length(probes[i].position - point), int(i)});
    const std::size_t n = std::min(found.size(), k_candidates);
    std::partial_sort(found.begin(), found.begin() + std::ptrdiff_t(n), found.end());
    std::vector<int> numbers;
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(found[i].second);
    return numbers;
}

}  // namespace

Result<void> fill_invalid(const RayScene& scene, std::span<Probe> probes, int threads) {
    if (std::ranges::none_of(probes, &Probe::valid))
        return Error{"all probes lie inside bodies, and none could be moved out", "",
                     "Place them in open space, or let them be moved `farthest` metres or more."};
    std::vector<int> source(probes.size(), -1);
    parallel_for(int(probes.size()), threads, [&](int i) {
        const Probe& probe = probes[std::size_t(i)];
        if (probe.valid) return;
        int fewest = k_most_surfaces + 1;
        for (const int candidate : nearest_valid(probes, probe.position)) {
            const int between = surfaces_between(scene, probes[std::size_t(candidate)].position, probe.position,
                                                 std::min(fewest, k_most_surfaces));
            if (between >= fewest) continue;
            fewest = between;
            source[std::size_t(i)] = candidate;
        }
    });
    for (std::size_t i = 0; i < probes.size(); ++i) probes[i].filled_from = source[i];
    return {};
}

}  // namespace domelight
