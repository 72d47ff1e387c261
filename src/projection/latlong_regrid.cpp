#include "projection/latlong_regrid.h"

#include "domelight/image/image.h"

#include <algorithm>
#include <cmath>

namespace domelight {

namespace {

/// Position, in samples, of texel centre i of n where the n samples go from edge to edge: (i + 1/2) (n - 1) / n.
double edge_to_edge(int i, int n) {
    return (i + 0.5) * (n - 1) / n;
}

class RegriddedRows : public RowSource {
  public:
    RegriddedRows(std::unique_ptr<RowSource> source, LatlongConvention::Grid grid)
        : source_(std::move(source)), grid_(grid), window_(source_->width(), 2, 3) {}

    int width() const override { return source_->width(); }
    int height() const override { return source_->height(); }

    Result<void> read(ImageView<float> rows) override {
        for (int y = 0; y < rows.height; ++y, ++next_row_) {
            const double position = edge_to_edge(next_row_, height());
            const int upper = int(position), lower = std::min(upper + 1, height() - 1);
            if (const auto filled = fill_until(lower); !filled) return filled;
            blend(window_.row(upper % 2), window_.row(lower % 2), position - upper, rows.row(y));
        }
        // Read the source's last row as well, so that its report is complete.
        return next_row_ == height() ? fill_until(height() - 1) : Result<void>();
    }

  private:
    /// Row r lives in the window's row r % 2.
    Result<void> fill_until(int row) {
        for (; rows_read_ <= row; ++rows_read_)
            if (const auto read = source_->read(window_.view().rows(rows_read_ % 2, 1)); !read) return read;
        return {};
    }

    void blend(const float* upper, const float* lower, double t, float* out) const {
        const int width = this->width();
        const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
        for (int x = 0; x < width; ++x) {
            const bool columns_too = grid_ == LatlongConvention::Grid::both_on_edges;
            const double position = columns_too ? edge_to_edge(x, width) : x;
            const int left = int(position), right = std::min(left + 1, width - 1);
            for (int c = 0; c < 3; ++c) {
                const double above = mix(upper[3 * left + c], upper[3 * right + c], position - left);
                const double below = mix(lower[3 * left + c], lower[3 * right + c], position - left);
                out[3 * x + c] = float(mix(above, below, t));
            }
        }
    }

    std::unique_ptr<RowSource> source_;
    LatlongConvention::Grid grid_;
    ImageF window_;
    int rows_read_ = 0, next_row_ = 0;
};

}  // namespace

std::unique_ptr<RowSource> regrid_latlong(std::unique_ptr<RowSource> source, LatlongConvention::Grid grid) {
    if (grid == LatlongConvention::Grid::centres) return source;
    return std::make_unique<RegriddedRows>(std::move(source), grid);
}

}  // namespace domelight
