#pragma once
// Filtered maps and arrays.

#include "domelight/filtering/prefilter.h"

#include "array_input.h"

#include <vector>

namespace domelight::python {

/// (6, size, size, 3) or (height, width, 3), which takes the map's memory. directed: the map is the light in single
/// directions, one row, and the array is (count, 3).
nb::object array_of(FilteredMap map, bool directed = false);

/// A copy of an array of shape (6, size, size, 3) or (height, 2 height, 3) as a map. Raises domelight.Error for others.
FilteredMap map_of(nb::handle array, const char* keyword);

/// The maps of a sequence of arrays. Raises domelight.Error where there are none, or of two layouts.
std::vector<FilteredMap> maps_of(nb::handle arrays, const char* keyword);

}  // namespace domelight::python
