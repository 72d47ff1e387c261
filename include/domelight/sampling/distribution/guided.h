#pragma once
// Inverse transform in constant time, in 32-bit fixed point.

#include "domelight/sampling/distribution/distribution.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// Cumulative tables of `count` discrete distributions over `items` items each, in quanta of 2^-32, with guide tables.
///
/// Item i of a distribution owns q_i of the 2^32 quanta: q_i = 0 if its weight is zero, otherwise q_i >= 1, and the sum
/// of all q_i is 2^32. The item drawn for xi is the one that owns quantum xi. The guide table (Chen and Asau 1974; the
/// "indexed search" or cutpoint method of Devroye 1986, III.2.4) has about as many cells as items. Cell k stores the
/// item that owns quantum number k 2^32 / cells, the first quantum of the cell. The search for any xi in the cell
/// starts there and takes two or three steps on average, whatever the weights.
struct GuidedRows {
    int count = 0, items = 0;
    int shift = 0;  ///< cell of xi: xi >> shift
    /// [count][1 + items], then 16 more: the last quantum of items -1, 0, 1, ...
    std::vector<std::uint32_t, LargeAllocator<std::uint32_t>> last;
    /// [count][cells + 8]: 8 unused, so that a row can be filled in whole vectors.
    std::vector<std::uint16_t, LargeAllocator<std::uint16_t>> guide;

    GuidedRows() = default;
    GuidedRows(int count, int items);
    /// Fills distribution `row` from the sums of its weights up to and including each item (sums.back() > 0).
    void fill(int row, std::span<const float> weights, std::span<const double> sums);
    /// Leaves distribution `row` without quanta. It must never be sampled.
    void fill_none(int row);

    int cells() const { return int((std::uint64_t(1) << 32) >> shift); }
    const std::uint32_t* last_of(int row) const { return last.data() + std::size_t(row) * (items + 1) + 1; }
    const std::uint16_t* guide_of(int row) const { return guide.data() + std::size_t(row) * (cells() + 8); }
    /// The item that owns quantum xi.
    int find(int row, std::uint32_t xi) const {
        const std::uint32_t* l = last_of(row);
        int i = guide_of(row)[std::uint64_t(xi) >> shift];
        while (l[i] < xi) ++i;
        return i;
    }
    /// Number of the first quantum that item i owns, if it owns any.
    std::uint32_t first_quantum(int row, int i) const { return last_of(row)[i - 1] + 1; }
    /// Quanta of item i, 1 .. 2^32; its weight must be positive.
    std::uint64_t quanta(int row, int i) const { return std::uint64_t(last_of(row)[i] - first_quantum(row, i)) + 1; }
    /// Quanta of any item, 0 .. 2^32.
    std::uint64_t quanta_or_none(int row, int i) const;
    std::size_t memory_bytes() const { return last.size() * sizeof(last[0]) + guide.size() * sizeof(guide[0]); }
};

/// A piecewise-constant density over [0, 1), sampled in constant time.
class GuidedDistribution1D {
  public:
    /// weights   n weights, finite, >= 0; all zero: the uniform density. Errors: none or more than 65535 weights; one
    /// that is NaN, infinite or negative.
    static Result<GuidedDistribution1D> build(std::span<const float> weights);

    struct Sample {
        double x;    ///< in [0, 1)
        double pdf;  ///< density per unit of x, > 0
        int index;   ///< of the weight drawn, which is not zero
    };
    Sample sample(std::uint32_t xi) const;
    double pdf(double x) const;
    std::optional<std::uint32_t> invert(double x) const;
    int size() const { return rows_.items; }
    std::size_t memory_bytes() const { return rows_.memory_bytes(); }

  private:
    GuidedRows rows_;
};

/// Marginal and conditional inverse transform by guide tables.
///
/// Monotone: a stratified or low-discrepancy set of points stays one in every row. A texel of positive weight can
/// always be drawn, one of zero weight never, and pdf_uv is computed from the same quanta as the sample. A UnitPoint
/// stands for the middle of its quantum, and invert(sample(p)) == p exactly. 6 bytes a texel.
class GuidedDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<GuidedDistribution> build(const Weights& weights, int threads = 1);

    DistributionSample sample(UnitPoint point) const override;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    void sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                std::span<float> pdf_uv) const override;
    int width() const override { return conditional_.items; }
    int height() const override { return conditional_.count; }
    std::size_t memory_bytes() const override { return marginal_.memory_bytes() + conditional_.memory_bytes(); }

    const GuidedRows& marginal() const { return marginal_; }        ///< of rows: one distribution
    const GuidedRows& conditional() const { return conditional_; }  ///< of columns: one distribution for each row

  private:
    GuidedRows marginal_, conditional_;
};

}  // namespace domelight
