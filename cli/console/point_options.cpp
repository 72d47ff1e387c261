#include "cli/console/point_options.h"

#include <fmt/core.h>

#include <utility>

namespace domelight::cli {

void add_point_options(Arguments& a, PointWords& w) {
    a.integer("--samples", "N", w.samples, "montecarlo: samples for each texel, 1 to 2^24 (1024)");
    a.choice("--sequence", w.sequence,
             "montecarlo: the sequence that the sample points are taken from; every texel uses the same points "
             "(hammersley)");
    a.text("--seed", "N", w.seed,
           "montecarlo: selects the randomisation of the points; 0: none for hammersley, halton, sobol and r2 (0)");
}

Result<PointSet> montecarlo_points(const PointWords& w, BakeMethod method) {
    const std::pair<const char*, bool> options[] = {
        {"--samples", w.samples.has_value()}, {"--sequence", w.sequence.has_value()}, {"--seed", !w.seed.empty()}};
    for (const auto& [option, given] : options)
        if (given && method != BakeMethod::montecarlo)
            return Error{fmt::format("has no meaning with --method {}", name_of(method)), option,
                         fmt::format("It belongs to --method {}.", name_of(BakeMethod::montecarlo))};
    PointSet points;
    points.count = w.samples.value_or(points.count);
    if (points.count < 1 || points.count > (1 << 24))
        return Error{fmt::format("{} is not from 1 to 2^24", points.count), "--samples", ""};
    points.sequence = w.sequence.value_or(points.sequence);
    if (w.seed.empty()) return points;
    const auto seed = parse_seed(w.seed);
    if (!seed) return seed.error().at("--seed");
    points.seed = *seed;
    return points;
}

}  // namespace domelight::cli
