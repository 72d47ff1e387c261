#include "sampling/distribution/weight_rows.h"

#include "domelight/base/parallel.h"

#include "base/text.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace domelight {

int running_sums(std::span<const float> weights, std::span<double> sums) {
    double sum = 0;
    bool bad = false;
    for (std::size_t x = 0; x < weights.size(); ++x) {
        const float w = weights[x];
        bad |= !(w >= 0 && w <= std::numeric_limits<float>::max());
        sums[x] = sum += w;
    }
    if (!bad) return -1;
    const auto first =
        std::find_if(weights.begin(), weights.end(), [](float w) { return !(w >= 0 && std::isfinite(w)); });
    return int(first - weights.begin());
}

const char* weight_fault(float weight) {
    return std::isnan(weight) ? "not a number" : weight < 0 ? "negative" : "infinite";
}

Result<void> for_each_weight_row(const Weights& weights, int threads,
                                 const std::function<void(int, std::span<const float>, std::span<const double>)>& use) {
    constexpr int k_most = 65535;  // columns are 16-bit numbers in the tables
    const int width = weights.width, height = weights.height;
    if (width < 1 || height < 1) return Error{"there are no texels to draw from", "", ""};
    if (width > k_most || height > k_most)
        return Error{text(width, " x ", height, " texels are too many to draw from: at most ", k_most, " on a side"),
                     "", "resample the environment to a smaller size"};

    std::vector<int> bad(height, -1);
    std::vector<float> bad_weight(height, 0.0f);
    parallel_ranges(height, 16, threads, [&](int begin, int end) {
        std::vector<float> room(width);
        std::vector<double> sums(width);
        for (int y = begin; y < end; ++y) {
            const std::span<const float> row = weights.row(y, room);
            assert(int(row.size()) == width);
            bad[y] = running_sums(row, sums);
            if (bad[y] >= 0)
                bad_weight[y] = row[bad[y]];
            else
                use(y, row, sums);
        }
    });
    for (int y = 0; y < height; ++y)
        if (bad[y] >= 0)
            return Error{
                text("the weight of the texel in column ", bad[y], ", row ", y, " is ", weight_fault(bad_weight[y])),
                "", "weights must be finite and not negative; repair the environment before drawing from it"};
    return {};
}

Weights uniform_weights(int width, int height) {
    return {width, height, [](int, std::span<float> room) {
                std::fill(room.begin(), room.end(), 1.0f);
                return std::span<const float>(room);
            }};
}

}  // namespace domelight
