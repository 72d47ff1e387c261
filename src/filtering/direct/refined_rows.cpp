#include "filtering/direct/refined_rows.h"

#include <algorithm>
#include <cassert>

namespace domelight {

RefinedRows::RefinedRows(int width, int height, int factor) : width_(width), height_(height), factor_(factor) {
    assert(factor % 2 == 1);
}

void RefinedRows::add_rows(ImageView<const float> rows) {
    before_ = std::move(last_);
    const float* last = rows.row(rows.height - 1);
    last_.assign(last, last + 3 * width_);  // the caller's rows are gone when the next ones come
    rows_ = rows;
    rows_added_ += rows.height;
    // Rows from the last centre on need the next row, unless there is none.
    end_row_ = rows_added_ == height_ ? height() : factor_ * (rows_added_ - 1) + factor_ / 2 + 1;
}

const float* RefinedRows::source_row(int y) const {
    const int first = rows_added_ - rows_.height;
    return y < first ? before_.data() : rows_.row(y - first);
}

void RefinedRows::read(int y, float* planes, std::ptrdiff_t stride) const {
    if (factor_ == 1) {
        const float* row = source_row(y);
        for (int x = 0; x < width_; ++x)
            for (int c = 0; c < 3; ++c) planes[c * stride + x] = row[3 * x + c];
        return;
    }
    // The row lies (2 y + 1 - factor) / (2 factor) rows below the first centre.
    const int up = y - factor_ / 2, above = up < 0 ? -1 : up / factor_;
    const float v = float(up - above * factor_) / float(factor_);
    const float* a = source_row(std::max(above, 0));
    const float* b = v > 0 ? source_row(std::min(above + 1, height_ - 1)) : a;
    std::vector<float> mixed(3 * std::size_t(width_) + 6);  // with the neighbours around the seam
    for (int i = 0; i < 3 * width_; ++i) mixed[std::size_t(i) + 3] = a[i] + v * (b[i] - a[i]);
    std::copy_n(mixed.end() - 6, 3, mixed.begin());
    std::copy_n(mixed.begin() + 3, 3, mixed.end() - 3);
    for (int k = 0; k < factor_; ++k) {
        const float u = float(k - factor_ / 2) / float(factor_);  // from the texel's centre
        const int from = u < 0 ? 0 : 3;
        const float t = u < 0 ? 1 + u : u;
        for (int x = 0; x < width_; ++x) {
            const float* p = mixed.data() + from + 3 * x;
            for (int c = 0; c < 3; ++c) planes[c * stride + factor_ * x + k] = p[c] + t * (p[c + 3] - p[c]);
        }
    }
}

}  // namespace domelight
