#pragma once

#include "domelight/base/vec.h"
#include "domelight/filtering/prefilter.h"

#include <array>
#include <functional>
#include <span>

namespace domelight {

/// Where the texels of a map go when it is stored for an engine: a cube is mirrored, a lat-long image is turned. Rows
/// are read in the new order from the map itself, which does not change. By default every texel keeps its place.
class TexelOrder {
  public:
    TexelOrder() = default;
    /// For cubes whose reader looks the light from world direction d up at `lookup` * d. The matrix exchanges and
    /// negates axes.
    static TexelOrder of_cube(const Mat3& lookup);
    /// For lat-long images whose centre shall lie `quarters` quarter turns further to the right. That many quarters of
    /// the width must be a whole number of columns.
    static TexelOrder of_latlong(int quarters);

    bool keeps_places() const { return keeps_places_; }
    /// Row `y` of a face in the new order: the map's own texels where they already lie so, otherwise copied to
    /// `scratch`, which takes a row.
    const float* row(const FilteredMap& map, int face, int y, float* scratch) const;
    /// All rows in the new order, from the first face to the last one.
    void for_each_row(const FilteredMap& map, const std::function<void(std::span<const float>)>& use) const;
    /// A copy in the new order.
    FilteredMap apply(const FilteredMap& map) const;

  private:
    /// Which texel (x, y) of a stored face comes from: of another face, with x and y exchanged first and then negated.
    struct FaceOrder {
        int face = 0;
        bool exchanged = false, negate_x = false, negate_y = false;
    };

    bool keeps_places_ = true;
    std::array<FaceOrder, 6> faces_{};
    int quarters_ = 0;
};

}  // namespace domelight
