#include "projection/convention_text.h"

#include "domelight/projection/projections.h"

#include "projection/latlong_convention.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace domelight {
namespace {

/// "+X".
std::string axis_name(const Vec3d& d) {
    const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    const double value = std::abs(d.x) == largest ? d.x : std::abs(d.y) == largest ? d.y : d.z;
    const char letter = std::abs(d.x) == largest ? 'X' : std::abs(d.y) == largest ? 'Y' : 'Z';
    return {value < 0 ? '-' : '+', letter};
}

const char* grid_text(SampleGrid grid) {
    return grid == SampleGrid::rows_on_poles   ? ", the first and last row on the poles"
           : grid == SampleGrid::both_on_edges ? ", samples from edge to edge"
                                               : "";
}

}  // namespace

std::string projection_convention(const std::string& name) {
    const auto projection = projection_from_name(name);
    if (!projection) return name;
    // The picture's own frame: x to the right, y up, z out of the centre.
    const Mat3 to_world = projection->world_to_picture().transposed();
    return (projection->name() == "latlong" ? "lat-long" : projection->name()) + ", centre " +
           axis_name(to_world * Vec3d{0, 0, 1}) + ", right " + axis_name(to_world * Vec3d{1, 0, 0}) + ", up " +
           axis_name(to_world * Vec3d{0, 1, 0}) + grid_text(projection->grid());
}

std::optional<std::string> latlong_of_convention(const std::string& text) {
    for (const auto& name : latlong_convention_names()) {
        const std::string projection = "latlong/" + std::string(name);
        if (text == projection_convention(projection)) return projection;
    }
    // "lat-long, centre +X, right +Z, up +Y": the axes stand in fixed places.
    const std::string pattern = "lat-long, centre +X, right +Z, up +Y";
    if (text.size() != pattern.size()) return std::nullopt;
    const auto axis = [&](std::string_view key) { return text.substr(pattern.find(key) + key.size(), 2); };
    const std::string projection =
        "latlong/centre=" + axis("centre ") + ",right=" + axis("right ") + ",up=" + axis("up ");
    if (!projection_from_name(projection) || projection_convention(projection) != text) return std::nullopt;
    return projection;
}

}  // namespace domelight
