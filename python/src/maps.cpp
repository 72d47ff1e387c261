#include "maps.h"

#include "base/field_place.h"

#include <fmt/format.h>

#include <utility>

namespace domelight::python {

nb::object array_of(FilteredMap map, bool directed) {
    const std::size_t height = std::size_t(map.height()), width = std::size_t(map.width());
    if (directed) {
        const std::size_t count = std::size_t(map.image.width());
        return numpy_of(std::move(map.image), {count, 3});
    }
    if (map.layout == Layout::cube) return numpy_of(std::move(map.image), {6, height, width, 3});
    return numpy_of(std::move(map.image), {height, width, 3});
}

FilteredMap map_of(nb::handle array, const char* keyword) {
    const ArrayPixels pixels = ArrayPixels::borrow(array, 3, keyword);
    const bool cube = pixels.charts() == 6 && pixels.chart_height() == pixels.width();
    const bool latlong = !pixels.has_charts() && pixels.width() == 2 * pixels.height();
    if (!cube && !latlong)
        throw Failure({fmt::format("a level of {} x {} texels in {} charts is no cube and no lat-long map",
                                   pixels.width(), pixels.chart_height(), pixels.charts()),
                       field_place(keyword), "Expected is (6, size, size, 3) or (height, 2 height, 3)."});
    return {cube ? Layout::cube : Layout::latlong, pixels.copy()};
}

std::vector<FilteredMap> maps_of(nb::handle arrays, const char* keyword) {
    std::vector<FilteredMap> maps;
    for (nb::handle array : arrays) {
        maps.push_back(map_of(array, keyword));
        if (maps.back().layout != maps.front().layout)
            throw Failure({"some levels are cubes and some lat-long maps", field_place(keyword), ""});
    }
    if (maps.empty()) throw Failure({"no levels", field_place(keyword), ""});
    return maps;
}

}  // namespace domelight::python
