#pragma once

#include "domelight/filtering/prefilter.h"

#include <span>
#include <vector>

namespace domelight {

/// Several filter runs over one reading of the rows. Each result has the same bits as prefilter() gives for its options
/// alone. The first run's `threads` and `progress` count while rows are read.
///
/// runs   at least one
Result<std::vector<FilterResult>> prefilter(RowSource& source, std::span<const FilterOptions> runs);

}  // namespace domelight
