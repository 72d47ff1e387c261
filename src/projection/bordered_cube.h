#pragma once

#include "domelight/image/image.h"

#include <utility>
#include <vector>

namespace domelight {

/// The texel at column x and row y of a face, or the one across the edge where one of the two is a step outside the face
/// (-1 or size): its index in the strip of faces, (face * size + row) * size + column.
int texel_or_across(int size, int face, int x, int y);

/// A cubemap's RGB texels with a border of one texel around each face, taken from across the edges; a corner of the
/// border is the mean of the three texels that meet there. Bilinear interpolation of a bordered face, up to the face's
/// edge, is the cube's reconstruction, which is continuous across edges.
class BorderedCube {
  public:
    explicit BorderedCube(const Cubemap& source);

    int size() const { return size_; }
    /// Texel of a face, column and row -1 .. size.
    const float* texel(int face, int column, int row) const {
        return texels_.data() + 3 * ((std::size_t(face) * (size_ + 2) + row + 1) * (size_ + 2) + column + 1);
    }

  private:
    float* texel(int face, int column, int row) {
        return const_cast<float*>(std::as_const(*this).texel(face, column, row));
    }

    int size_;
    std::vector<float> texels_;
};

}  // namespace domelight
