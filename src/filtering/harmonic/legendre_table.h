#pragma once

#include "filtering/harmonic/legendre_walk.h"

#include <vector>

namespace domelight {

/// What LegendreWalk::walk() visits, of all orders, kept in memory: for transforms of one band limit that are made many
/// times. About 2 L^2 rings bytes.
class LegendreTable {
  public:
    LegendreTable(const NorthernRings& rings, int band_limit);

    /// Makes the same calls of visit() as LegendreWalk::walk().
    template <typename Visit>
    void walk(int m, int parity, const Visit& visit) const {
        const std::size_t block = 2 * std::size_t(m) + std::size_t(parity);
        for (std::size_t i = begin_[block]; i < begin_[block + 1]; ++i)
            visit(chunks_[i].first, chunks_[i].count, chunks_[i].first_ring, rows_.data() + chunks_[i].at);
    }

  private:
    struct Chunk {
        int first, count, first_ring;
        std::size_t at;  ///< where its rows start in rows_
    };
    std::vector<std::size_t> begin_;  ///< [2 m + parity]: the first of their chunks
    std::vector<Chunk> chunks_;
    AlignedArray<float> rows_;
};

}  // namespace domelight
