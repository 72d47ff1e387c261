#include "filtering/lights/light_groups.h"

#include "base/sort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace domelight {
namespace {

/// Orders points so that each run of LightGroups::k_size are neighbours: halves along the longest axis, cut at a
/// multiple of the size.
void sort_by_place(const PointLights& points, std::span<int> order) {
    if (int(order.size()) <= LightGroups::k_size) return;
    const std::array<const std::vector<float>*, 3> axes{&points.x, &points.y, &points.z};
    const std::vector<float>* longest = nullptr;
    float most = -1;
    for (const auto* axis : axes) {
        const auto [low, high] =
            std::minmax_element(order.begin(), order.end(), [&](int a, int b) { return (*axis)[a] < (*axis)[b]; });
        const float extent = (*axis)[*high] - (*axis)[*low];
        if (extent > most) most = extent, longest = axis;
    }
    const std::size_t groups = (order.size() + LightGroups::k_size - 1) / LightGroups::k_size;
    const std::size_t half = (groups / 2) * LightGroups::k_size;
    // Ties are broken by index, so that the order is the same everywhere.
    std::nth_element(order.begin(), order.begin() + half, order.end(),
                     [&](int a, int b) { return std::pair((*longest)[a], a) < std::pair((*longest)[b], b); });
    sort_items(order.first(half));
    sort_items(order.subspan(half));
    sort_by_place(points, order.first(half));
    sort_by_place(points, order.subspan(half));
}

}  // namespace

LightGroups::LightGroups(const PointLights& points) : used(points.count()) {
    std::vector<int> order(points.count());
    std::iota(order.begin(), order.end(), 0);
    sort_by_place(points, order);
    const float black[3] = {};
    for (int from = 0; from < used; from += k_size) {
        const int end = std::min(from + k_size, used);
        Vec3d centre, strongest;
        for (int i = from; i < end; ++i) {
            const int p = order[i];
            lights.append(points, p, p + 1);
            centre += points.place(p);
            strongest = {std::max(strongest.x, double(points.r[p])), std::max(strongest.y, double(points.g[p])),
                         std::max(strongest.z, double(points.b[p]))};
        }
        for (int i = end; i < from + k_size; ++i) lights.add(points.place(order[end - 1]), 0, black);
        // The lights of a group that spans the sphere may cancel.
        centre = length(centre) > 1e-3 ? normalize(centre) : points.place(order[from]);
        double farthest = 0;
        for (int i = from; i < end; ++i) farthest = std::max(farthest, length(points.place(order[i]) - centre));
        x.push_back(float(centre.x)), y.push_back(float(centre.y)), z.push_back(float(centre.z));
        radius.push_back(float(farthest) + 1e-6f);
        most.push_back(strongest);
    }
    while (count() % k_padding) {
        for (int i = 0; i < k_size; ++i) lights.add({1, 0, 0}, 0, black);
        x.push_back(1), y.push_back(0), z.push_back(0), radius.push_back(0);
        most.push_back({});
    }
}

}  // namespace domelight
