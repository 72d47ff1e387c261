#pragma once

#include "domelight/image/image.h"

#include <vector>

namespace domelight {

/// Rows of a lat-long image, `factor` times as many and each `factor` times as long, with the same bilinear
/// reconstruction (u wraps; v is constant in the half rows at the poles): the new texels hold its values at their
/// centres. The factor is odd, so that a centre remains a centre.
class RefinedRows {
  public:
    RefinedRows(int width, int height, int factor);

    int width() const { return factor_ * width_; }
    int height() const { return factor_ * height_; }
    bool is_interpolated() const { return factor_ > 1; }

    /// The next rows, at least one. Rows [next_row(), end_row()) can be read as long as these are there.
    void add_rows(ImageView<const float> rows);
    int next_row() const { return next_row_; }
    int end_row() const { return end_row_; }
    /// Says that the rows before `row` have been read.
    void advance_to(int row) { next_row_ = row; }
    /// Row y of the refined image into three planes of width() values, `stride` floats apart.
    void read(int y, float* planes, std::ptrdiff_t stride) const;

  private:
    const float* source_row(int y) const;

    int width_, height_, factor_;
    int rows_added_ = 0, next_row_ = 0, end_row_ = 0;
    ImageView<const float> rows_;  ///< the ones added last
    std::vector<float> before_;    ///< the row before them
    std::vector<float> last_;      ///< the last one of them
};

}  // namespace domelight
