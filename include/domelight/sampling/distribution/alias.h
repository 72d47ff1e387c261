#pragma once
// Alias tables in 32-bit fixed point.

#include "domelight/sampling/distribution/distribution.h"

#include <cstdint>
#include <vector>

namespace domelight {

/// Alias tables of `count` discrete distributions over `items` items each, in quanta of 2^-32 (Walker 1974; Vose 1991).
///
/// The 2^32 quanta are distributed exactly as in GuidedRows, then packed into 2^bits cells of equal size, 2^bits >=
/// items: the first `split` quanta of a cell belong to the item with the cell's number, the rest to its alias. The
/// upper bits of xi choose the cell, the lower bits the position in it, so nothing is rounded: each item is drawn for
/// exactly as many of the 2^32 numbers xi as it owns quanta. Alias and split together take 32 bits, so the other half
/// of an entry can hold the item's quanta, and hence its density.
struct AliasRows {
    struct Entry {
        std::uint32_t last_quantum;     ///< quanta of the cell's own item, less 1
        std::uint32_t alias_and_split;  ///< alias in the upper `bits`, split in the lower 32 - bits
    };
    int count = 0, items = 0, bits = 0;
    std::vector<Entry, LargeAllocator<Entry>> entries;  ///< [count][2^bits]

    AliasRows() = default;
    AliasRows(int count, int items);
    /// Fills distribution `row` from the sums of its weights up to and including each item (sums.back() > 0).
    void fill(int row, std::span<const float> weights, std::span<const double> sums);

    /// An item, the position within it, and how many quanta it has.
    struct Draw {
        int item;
        double t;  ///< position in the item, in (0, 1): the position in that part of the cell that belongs to the item
        double quanta;
    };
    Draw draw(int row, std::uint32_t xi) const;
    /// Quanta of an item; 0 for an item of weight zero.
    double quanta_or_none(int row, int item) const;
    const Entry* row(int row) const { return entries.data() + (std::size_t(row) << bits); }
    std::size_t memory_bytes() const { return entries.size() * sizeof(Entry); }
};

/// Marginal and conditional sampling by alias tables: one fetch for a row, one or two for a column, no search.
///
/// The fastest method for random points. Neighbouring points are separated, so a low-discrepancy set loses its
/// advantage, and a lattice does worse than random points: the lower bits of Hammersley points, which choose between
/// item and alias, are all alike (4096 of them on a 4096 x 2048 sunrise: relative error 0.46, random points 0.04).
/// Densities are those of GuidedDistribution, to the bit. 2^32 positions are resolved in each direction. 8 bytes a
/// texel where the width is a power of two, otherwise up to twice that.
class AliasDistribution final : public Distribution2D {
  public:
    /// Errors: as make_distribution.
    static Result<AliasDistribution> build(const Weights& weights, int threads = 1);

    DistributionSample sample(UnitPoint point) const override;
    double pdf_uv(double u, double v) const override;
    void sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                std::span<float> pdf_uv) const override;
    int width() const override { return conditional_.items; }
    int height() const override { return conditional_.count; }
    std::size_t memory_bytes() const override { return marginal_.memory_bytes() + conditional_.memory_bytes(); }

  private:
    AliasRows marginal_, conditional_;
};

}  // namespace domelight
