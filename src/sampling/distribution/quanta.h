#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace domelight {

/// Distributes `total` quanta among items in proportion to their weights: calls use(i, end) with the number of quanta
/// of items 0 .. i together.
///
/// positive   positive(i): whether item i has a weight
/// sums       of the weights of items 0 .. i, in double; sums.back() > 0
///
/// Each item of positive weight first gets one quantum, so that none is lost beside a sun. The rest is distributed by
/// the cumulative sums rounded down, so an item is off by at most one quantum and errors do not accumulate. An item of
/// weight 0 gets exactly none.
template <typename Positive, typename Use>
void share_quanta(const Positive& positive, std::span<const double> sums, std::uint64_t total, const Use& use) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) count += positive(int(i));
    const double last = sums.back();
    const std::int64_t rest = std::int64_t(total) - count;
    const double scale = double(rest) / last;
    std::int64_t owners = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        owners += positive(int(i));
        // The last positive item gets what is left by rounding.
        const std::int64_t by_sum = sums[i] >= last ? rest : std::min(std::int64_t(sums[i] * scale), rest);
        use(int(i), std::uint64_t(owners + by_sum));
    }
}

}  // namespace domelight
