#include "bake/panorama.h"

#include "domelight/projection/projections.h"
#include "domelight/filtering/resample/reproject.h"

#include "bake/mirror.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace domelight {

namespace {

/// Quarter turns about +Y from the default lat-long convention to this one; none where that is not all.
std::optional<int> quarter_turns(const Projection& projection, int size) {
    if (projection.name() != "latlong" || projection.grid() != SampleGrid::centres) return std::nullopt;
    const Vec3d centre = projection.direction(0, {0.5, 0.5}), right = projection.direction(0, {0.75, 0.5}),
                up = projection.direction(0, {0.5, 0});
    const int quarters = int(std::lround(std::atan2(centre.z, centre.x) * 2 / k_pi)) & 3;
    const double angle = quarters * k_pi / 2;
    const auto near = [](const Vec3d& a, const Vec3d& b) { return length(a - b) < 1e-9; };
    if (!near(centre, {std::cos(angle), 0, std::sin(angle)}) || !near(right, {-std::sin(angle), 0, std::cos(angle)}) ||
        !near(up, {0, 1, 0}))
        return std::nullopt;
    // Two rows are twice as wide as high: a quarter of an odd height's width is no whole number of columns.
    if (quarters % 2 && size % 2) return std::nullopt;
    return quarters;
}

}  // namespace

int panorama_rows(const std::string& name, int size) {
    const auto projection = projection_from_name(name);
    return projection && quarter_turns(*projection, size) ? size : 2 * size;
}

Result<ImageF> project_panorama(const ImageF& latlong, const std::string& name, int size, int threads) {
    const auto projection = projection_from_name(name);
    if (!projection) return projection.error();
    ImageF copy = latlong;
    if (const auto quarters = quarter_turns(*projection, size); quarters && latlong.height() == size) {
        turn_latlong(copy, *quarters);
        return copy;
    }
    const ProjectedImage source{*projection_from_name("latlong"), std::move(copy)};
    const int width = int(std::lround(size * projection->shape().aspect()));
    return std::move(reproject(source, *projection, width, size, threads).pixels);
}

std::string projection_convention(const std::string& name) {
    const auto projection = projection_from_name(name);
    if (!projection) return name;
    const auto axis = [](const Vec3d& d) -> std::string {
        const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        const double value = std::abs(d.x) == largest ? d.x : std::abs(d.y) == largest ? d.y : d.z;
        const char letter = std::abs(d.x) == largest ? 'X' : std::abs(d.y) == largest ? 'Y' : 'Z';
        return {value < 0 ? '-' : '+', letter};
    };
    // The picture's own frame: x to the right, y up, z out of the centre.
    const Mat3 to_world = projection->world_to_picture().transposed();
    const char* grid = projection->grid() == SampleGrid::rows_on_poles   ? ", the first and last row on the poles"
                       : projection->grid() == SampleGrid::both_on_edges ? ", samples from edge to edge"
                                                                         : "";
    return fmt::format(
        "{}, centre {}, right {}, up {}{}", projection->name() == "latlong" ? "lat-long" : projection->name(),
        axis(to_world * Vec3d{0, 0, 1}), axis(to_world * Vec3d{1, 0, 0}), axis(to_world * Vec3d{0, 1, 0}), grid);
}

}  // namespace domelight
