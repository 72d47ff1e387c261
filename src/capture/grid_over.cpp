#include "domelight/capture/placement.h"

#include "base/field_place.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

Result<Vec3d> size_of(const ProbeBox& box) {
    const Vec3d size = Vec3d(box.high) - Vec3d(box.low);
    const double smallest = std::min({size.x, size.y, size.z}), largest = std::max({size.x, size.y, size.z});
    if (smallest >= 0 && largest > 0 && std::isfinite(largest)) return size;
    return Error{fmt::format("from ({}, {}, {}) to ({}, {}, {}) has no volume to place probes in", box.low.x, box.low.y,
                             box.low.z, box.high.x, box.high.y, box.high.z),
                 field_place("region"), "Its second corner must have the larger coordinates."};
}

/// The places on an axis of this length, at most `apart` metres apart, and half of that or less from its ends.
int places_on(double length, double apart) {
    return int(std::min(std::max(std::ceil(length / apart), 1.0), 1e6));
}

/// How many places a grid of this density has.
double count_at(const Vec3d& size, double density) {
    const double apart = 1 / std::sqrt(density);
    return double(places_on(size.x, apart)) * places_on(size.y, apart) * places_on(size.z, apart);
}

}  // namespace

Result<ProbeGrid> grid_over(const ProbeBox& box, int nx, int ny, int nz) {
    const auto size = size_of(box);
    if (!size) return size.error();
    ProbeGrid grid{.nx = nx, .ny = ny, .nz = nz};
    const struct {
        const char* axis;
        int places;
        double length;
        float &spacing, &origin;
    } axes[] = {{"X", nx, size->x, grid.spacing.x, grid.origin.x},
                {"Y", ny, size->y, grid.spacing.y, grid.origin.y},
                {"Z", nz, size->z, grid.spacing.z, grid.origin.z}};
    grid.origin = box.low;
    for (const auto& a : axes) {
        if (a.places < 1 || a.places > 4096)
            return Error{fmt::format("{} places along {} are not from 1 to 4096", a.places, a.axis),
                         field_place("grid"), ""};
        if (a.length > 0) {
            a.spacing = float(a.length / a.places);
            a.origin += a.spacing / 2;
        } else if (a.places > 1) {
            return Error{fmt::format("{} places along {}, where the region has no extent", a.places, a.axis),
                         field_place("grid"), ""};
        }
    }
    return grid;
}

Result<ProbeGrid> grid_over(const ProbeBox& box, const GridOptions& options) {
    if (!(options.density > 0) || !std::isfinite(options.density))
        return Error{fmt::format("{} is not a number above 0", options.density), field_place("density"),
                     "1 is a probe for each square metre."};
    const auto size = size_of(box);
    if (!size) return size.error();
    const double count = count_at(*size, options.density);
    if (count > options.most) {
        double fewer = options.density;
        while (count_at(*size, fewer) > options.most) fewer *= 0.97;
        return Error{fmt::format("{} needs {} probes, and at most {} are allowed", options.density, std::int64_t(count),
                                 options.most),
                     field_place("density"), fmt::format("{:.3g} to the square metre would do.", 0.995 * fewer)};
    }
    const double apart = 1 / std::sqrt(options.density);
    return grid_over(box, places_on(size->x, apart), places_on(size->y, apart), places_on(size->z, apart));
}

std::vector<Vec3f> places_of(const ProbeGrid& grid) {
    std::vector<Vec3f> places;
    for (int i = 0; i < grid.count(); ++i) places.push_back(grid.place(i));
    return places;
}

}  // namespace domelight
