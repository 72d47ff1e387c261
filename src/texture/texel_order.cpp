#include "texture/texel_order.h"

#include "domelight/projection/projection.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace domelight {

TexelOrder TexelOrder::of_cube(const Mat3& lookup) {
    TexelOrder order;
    order.keeps_places_ = lookup == Mat3();
    const Mat3 world_of_stored = lookup.transposed();
    for (int f = 0; f < 6; ++f) {
        // Three points of the face show which way its axes run in the face that they come from.
        const auto source = [&](UV uv) { return cube_point(world_of_stored * cube_direction(f, uv)); };
        const CubePoint from = source({0.25, 0.25}), right = source({0.75, 0.25}), below = source({0.25, 0.75});
        const double u_by_x = right.uv.u - from.uv.u, v_by_x = right.uv.v - from.uv.v;
        const double u_by_y = below.uv.u - from.uv.u, v_by_y = below.uv.v - from.uv.v;
        const bool exchanged = std::abs(u_by_x) < std::abs(v_by_x);
        order.faces_[std::size_t(f)] = {from.face, exchanged, (exchanged ? u_by_y : u_by_x) < 0,
                                        (exchanged ? v_by_x : v_by_y) < 0};
    }
    return order;
}

TexelOrder TexelOrder::of_latlong(int quarters) {
    TexelOrder order;
    order.quarters_ = (quarters % 4 + 4) % 4;
    order.keeps_places_ = order.quarters_ == 0;
    return order;
}

const float* TexelOrder::row(const FilteredMap& map, int face, int y, float* scratch) const {
    assert(map.image.channels() == 3);
    const int width = map.width(), last = width - 1;
    if (keeps_places_) return map.face(face).row(y);
    if (map.layout == Layout::latlong) {
        const float* row = map.image.row(y);
        std::rotate_copy(row, row + 3 * (std::ptrdiff_t(width) * quarters_ / 4), row + 3 * std::ptrdiff_t(width),
                         scratch);
        return scratch;
    }
    const FaceOrder& from = faces_[std::size_t(face)];
    const auto source = map.face(from.face);
    if (from.exchanged) {
        const int column = from.negate_x ? last - y : y;
        for (int x = 0; x < width; ++x)
            std::copy_n(source.at(column, from.negate_y ? last - x : x), 3, scratch + 3 * std::ptrdiff_t(x));
        return scratch;
    }
    const float* row = source.row(from.negate_y ? last - y : y);
    if (!from.negate_x) return row;
    for (int x = 0; x < width; ++x) std::copy_n(row + 3 * std::ptrdiff_t(last - x), 3, scratch + 3 * std::ptrdiff_t(x));
    return scratch;
}

void TexelOrder::for_each_row(const FilteredMap& map, const std::function<void(std::span<const float>)>& use) const {
    std::vector<float> scratch(3 * std::size_t(map.width()));
    for (int f = 0; f < map.faces(); ++f)
        for (int y = 0; y < map.height(); ++y) use({row(map, f, y, scratch.data()), scratch.size()});
}

FilteredMap TexelOrder::apply(const FilteredMap& map) const {
    if (keeps_places_) return map;
    FilteredMap stored(map.layout, ImageF::uninitialized(map.image.width(), map.image.height(), 3));
    float* to = stored.pixels().data();
    for_each_row(map, [&](std::span<const float> row) { to = std::copy(row.begin(), row.end(), to); });
    return stored;
}

}  // namespace domelight
