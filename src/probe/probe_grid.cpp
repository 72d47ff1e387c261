#include "domelight/probe/probe_grid.h"

#include <algorithm>

namespace domelight {
namespace {

struct AxisCell {
    int low, high;
    float fraction;
};

AxisCell axis_cell(float at, float origin, float spacing, int count) {
    // 0 also for what is not a number.
    const float t = at > origin ? std::min((at - origin) / spacing, float(count - 1)) : 0;
    const int low = std::min(int(t), std::max(count - 2, 0));
    return {low, std::min(low + 1, count - 1), t - float(low)};
}

}  // namespace

GridCell cell_at(const ProbeGrid& grid, const Vec3f& point) {
    const AxisCell x = axis_cell(point.x, grid.origin.x, grid.spacing.x, grid.nx),
                   y = axis_cell(point.y, grid.origin.y, grid.spacing.y, grid.ny),
                   z = axis_cell(point.z, grid.origin.z, grid.spacing.z, grid.nz);
    GridCell cell;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const bool hx = corner & 1, hy = corner & 2, hz = corner & 4;
        cell.place[corner] = grid.index(hx ? x.high : x.low, hy ? y.high : y.low, hz ? z.high : z.low);
        cell.weight[corner] = (hx ? x.fraction : 1 - x.fraction) * (hy ? y.fraction : 1 - y.fraction) *
                              (hz ? z.fraction : 1 - z.fraction);
    }
    return cell;
}

}  // namespace domelight
