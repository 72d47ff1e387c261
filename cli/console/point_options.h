#pragma once

#include "domelight/bake/bake.h"
#include "domelight/sampling/sequences.h"

#include "cli/console/arguments.h"

#include <optional>
#include <string>

namespace domelight::cli {

/// The words of --samples, --sequence and --seed, which belong to --method montecarlo.
struct PointWords {
    std::optional<int> samples;
    std::optional<Sequence> sequence;
    std::string seed;
};

void add_point_options(Arguments& arguments, PointWords& words);

/// The points that were asked for. Errors: an option that has no meaning with `method`; a value that is not accepted.
Result<PointSet> montecarlo_points(const PointWords& words, BakeMethod method);

}  // namespace domelight::cli
