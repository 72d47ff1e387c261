#include "compare/plane_filter.h"

#include "domelight/base/parallel.h"

#include <algorithm>

namespace domelight {

ImageF filter_plane(ImageView<const float> plane, const Taps& along, const Taps& down, int threads) {
    const int width = plane.width, height = plane.height;
    const int reach_x = int(along.size()) / 2, reach_y = int(down.size()) / 2;
    ImageF across(width, height, 1), result(width, height, 1);
    parallel_ranges(height, 16, threads, [&](int begin, int end) {
        std::vector<float> padded(std::size_t(width) + 2 * reach_x);
        for (int y = begin; y < end; ++y) {
            const float* in = plane.row(y);
            std::fill_n(padded.begin(), reach_x, in[0]);
            std::copy_n(in, width, padded.begin() + reach_x);
            std::fill_n(padded.begin() + reach_x + width, reach_x, in[width - 1]);
            float* out = across.row(y);
            for (std::size_t k = 0; k < along.size(); ++k) {
                const float w = along[k], *from = padded.data() + k;
                for (int x = 0; x < width; ++x) out[x] += w * from[x];
            }
        }
    });
    parallel_for(height, threads, [&](int y) {
        float* out = result.row(y);
        for (std::size_t k = 0; k < down.size(); ++k) {
            const float w = down[k], *from = across.row(std::clamp(y + int(k) - reach_y, 0, height - 1));
            for (int x = 0; x < width; ++x) out[x] += w * from[x];
        }
    });
    return result;
}

}  // namespace domelight
