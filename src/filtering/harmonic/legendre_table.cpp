#include "filtering/harmonic/legendre_table.h"

namespace domelight {

LegendreTable::LegendreTable(const NorthernRings& rings, int band_limit) {
    std::size_t rows = 0;
    for (int m = 0; m <= band_limit; ++m)
        for (int parity = 0; parity < 2; ++parity)
            rows += std::size_t(LegendreWalk::padded_count(band_limit, m, parity));
    rows_ = AlignedArray<float>(rows * std::size_t(rings.padded));
    LegendreWalk walk(rings, band_limit);
    std::size_t at = 0;
    for (int m = 0; m <= band_limit; ++m)
        for (int parity = 0; parity < 2; ++parity) {
            begin_.push_back(chunks_.size());
            walk.walk(m, parity, [&](int first, int count, int first_ring, const float* p) {
                const std::size_t values = std::size_t(count) * std::size_t(rings.padded);
                chunks_.push_back({first, count, first_ring, at});
                std::copy_n(p, values, rows_.data() + at);
                at += values;
            });
        }
    begin_.push_back(chunks_.size());
}

}  // namespace domelight
