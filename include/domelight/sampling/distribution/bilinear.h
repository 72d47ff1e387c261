#pragma once
// A continuous density, bilinear between texel centres like the radiance of a bilinear lookup. docs/math/sampling.md
// derives it.

#include "domelight/sampling/distribution/distribution.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// Cumulative tables, shapes and guides of `count` piecewise-linear densities of `items` segments each, in quanta of 1
/// / (2^32 - 1).
///
/// A segment has a whole number of quanta, at least one unless the density is zero at both ends, and a shape r: along
/// the segment the density changes linearly from 2 r to 2 (1 - r) times the segment's average.
struct BilinearRows {
    static constexpr std::uint32_t k_total = 0xffffffffu;
    int count = 0, items = 0;
    int shift = 0;  ///< guide cell of xi: xi >> shift
    /// [count][items + 1], then 16 unused: quanta before each segment, from 0 to k_total, minus 2^31. They are signed
    /// because vector instructions convert signed integers to double.
    std::vector<std::int32_t, LargeAllocator<std::int32_t>> edges;
    std::vector<std::uint16_t, LargeAllocator<std::uint16_t>> shape;  ///< [count][items]: r in 1 / 65535
    /// [count][cells + 8]: first segment that ends at the cell's first quantum or later.
    std::vector<std::uint16_t, LargeAllocator<std::uint16_t>> guide;

    BilinearRows() = default;
    BilinearRows(int count, int items);
    /// Fills row `row` from the densities at the segments' ends, begins[i] and ends[i]; one of them is positive.
    void fill(int row, std::span<const double> begins, std::span<const double> ends);
    /// Makes a row of zeros uniform, in case it is ever drawn from.
    void fill_uniform(int row);

    int cells() const { return int((std::uint64_t(1) << 32) >> shift); }
    const std::int32_t* edges_of(int row) const { return edges.data() + std::size_t(row) * (items + 1); }
    /// Quanta of a segment.
    double quanta(int row, int i) const { return double(edges_of(row)[i + 1]) - edges_of(row)[i]; }
    const std::uint16_t* shape_of(int row) const { return shape.data() + std::size_t(row) * items; }
    const std::uint16_t* guide_of(int row) const { return guide.data() + std::size_t(row) * (cells() + 8); }
    std::size_t memory_bytes() const {
        return edges.size() * sizeof(edges[0]) + (shape.size() + guide.size()) * sizeof(shape[0]);
    }
};

/// Ten consecutive segments of a row of BilinearColumns, in one cache line.
struct alignas(64) BilinearLine {
    static constexpr int k_segments = 10;
    std::int32_t edges[k_segments + 1];  ///< as BilinearRows::edges; k_total beyond the row's end
    std::uint16_t shape[k_segments];     ///< as BilinearRows::shape
};

/// The rows of BilinearRows laid out for drawing from a mixture of two neighbouring rows: a draw takes a cache line from
/// the guide and nearly always one from each row.
struct BilinearColumns {
    int count = 0, items = 0;
    int lines_per_row = 0;
    int shift = 0;  ///< guide cell of xi: xi >> shift. A cell is four times as wide as in BilinearRows.
    std::vector<BilinearLine, LargeAllocator<BilinearLine>> lines;  ///< [count][lines_per_row]
    /// [count - 1][cells + 1][2]: the guides of rows s and s + 1 side by side.
    std::vector<std::uint16_t, LargeAllocator<std::uint16_t>> guides;

    BilinearColumns() = default;
    BilinearColumns(int count, int items);
    /// Row `row` becomes the only row of `from`. Different rows may be set at the same time.
    void set(int row, const BilinearRows& from);

    int cells() const { return int((std::uint64_t(1) << 32) >> shift); }
    std::size_t guide_stride() const { return 2 * (std::size_t(cells()) + 1); }
    /// The cell of xi in the guides of rows s and s + 1: first segments of row s and of row s + 1, then those of the next
    /// cell.
    const std::uint16_t* guide_of(int s, std::uint32_t xi) const {
        return guides.data() + std::size_t(s) * guide_stride() + 2 * (std::uint64_t(xi) >> shift);
    }
    const BilinearLine* row(int r) const { return lines.data() + std::size_t(r) * lines_per_row; }
    std::size_t memory_bytes() const { return lines.size() * sizeof(lines[0]) + guides.size() * sizeof(guides[0]); }
};

/// p(u, v) = bilinear interpolation of the weights between texel centres / mean weight; u wraps around, v is clamped in
/// the half rows at the top and the bottom. The mean of the weights is the interpolation's integral, exactly.
///
/// First v is drawn by its marginal, which has H + 1 segments (half a row, linear, ..., half a row). At v = (j + 1/2 +
/// t) / H the density along u is the mixture of rows j and j + 1 in proportion to (1 - t) S_j and t S_{j+1}, with S the
/// sum of a row. Its cumulative function is the mixture of theirs, and its root lies between the roots of the two rows,
/// which the guide tables bracket. Choosing one of the rows at random would be exact too, but neither monotone nor
/// invertible.
///
/// Monotone in both directions (u starts at the first texel centre, 1 / (2 W), and continues across the seam).
/// invert(sample(p)) == p exactly, except where a row outweighs its neighbour by 10^4 or more: there (u, v) in double
/// are not precise enough, and the result is off by a few quanta of 2^-32. 7.4 bytes a texel.
class BilinearDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<BilinearDistribution> build(const Weights& weights, int threads = 1);

    DistributionSample sample(UnitPoint point) const override;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    void sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                std::span<float> pdf_uv) const override;
    void pdfs_uv(std::span<const float> u, std::span<const float> v, std::span<float> pdf_uv) const override;
    int width() const override { return columns_.items; }
    int height() const override { return columns_.count - 2; }
    bool continuous() const override { return true; }
    std::size_t memory_bytes() const override {
        return rows_.memory_bytes() + columns_.memory_bytes() + row_begins_.size() * sizeof(double);
    }

  private:
    // one density of height + 1 segments; its shapes are not used, because row_begins_ holds them more precisely.
    BilinearRows rows_;
    // For each row, the segments from centre to centre; the last one crosses the seam. The first and the last row are
    // stored twice, so that segment s of v always lies between rows s and s + 1 of the table.
    BilinearColumns columns_;
    // [height + 1]: the marginal's value at the beginning of each segment, in quanta a segment.
    std::vector<double> row_begins_;
};

/// The same density in double by linear search, in the simplest form. BilinearDistribution is tested against it.
class PlainBilinearDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<PlainBilinearDistribution> build(const Weights& weights);

    DistributionSample sample(UnitPoint point) const override;
    using Distribution2D::sample;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    int width() const override { return width_; }
    int height() const override { return height_; }
    bool continuous() const override { return true; }
    std::size_t memory_bytes() const override { return (weights_.size() + row_sums_.size()) * sizeof(double); }

  private:
    double node(int i, int j, double t) const;  // weight of column i at t between rows j and j + 1

    int width_ = 0, height_ = 0;
    double total_ = 0;
    std::vector<double> weights_, row_sums_;
};

}  // namespace domelight
