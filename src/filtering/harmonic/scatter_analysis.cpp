#include "filtering/harmonic/scatter_analysis.h"

#include "domelight/base/parallel.h"

#include <algorithm>
#include <complex>

namespace domelight {
namespace {

/// Adds the columns beyond the ends of each row to the columns that they repeat, and the other grids to the first.
void gather_grids(std::vector<SphereGrid>& grids, int threads) {
    const RingGrid grid = grids[0].grid();
    constexpr int pad = SphereGrid::k_pad;
    parallel_ranges(grid.rings + 2 * pad, 16, threads, [&](int begin, int end) {
        for (int k = begin - pad; k < end - pad; ++k) {
            float* row = grids[0].ring(k);
            for (std::size_t g = 1; g < grids.size(); ++g)
                for (int i = -4 * pad; i < 4 * (grid.width + 2 * pad); ++i) row[i] += grids[g].ring(k)[i];
            for (int i = 0; i < 4 * pad; ++i) row[4 * (grid.width - pad) + i] += row[i - 4 * pad];
            for (int i = 0; i < 8 * pad; ++i) row[i] += row[4 * grid.width + i];
        }
    });
}

}  // namespace

ScatterAnalysis::ScatterAnalysis(std::shared_ptr<const RingTransform> with)
    : rings_(with, std::vector<std::complex<double>>(std::size_t(with->band_limit) + 1, 1)),
      table_(lookup_table(double(with->band_limit) / with->grid.rings)) {}

Spectrum ScatterAnalysis::finish(std::vector<SphereGrid>& grids, int threads) {
    gather_grids(grids, threads);
    const std::ptrdiff_t stride = grids[0].view().stride;
    parallel_for(rings_.batch_count(), threads, [&](int batch) {
        const int first = batch * RingAnalysis::k_batch,
                  rows = std::min(RingAnalysis::k_batch, rings_.row_count() - first);
        const float* from = grids[0].ring(first - RingAnalysis::k_pad);
        const std::ptrdiff_t used = 4 * std::ptrdiff_t(grid().width);
        const auto is_black = [&](int k) {
            return std::all_of(from + k * stride, from + k * stride + used, [](float v) { return v == 0; });
        };
        int lit = 0;
        while (lit < rows && is_black(lit)) ++lit;
        if (lit == rows) return rings_.clear(batch);
        AlignedArray<float> padded;
        if (rows < RingAnalysis::k_batch) {
            padded = AlignedArray<float>(std::size_t(RingAnalysis::k_batch) * stride);
            for (int k = 0; k < rows; ++k) std::copy_n(from + k * stride, used, padded.data() + k * stride);
            from = padded.data();
        }
        for (int channel = 0; channel < 3; ++channel) rings_.transform(from, stride, 4, batch, channel);
    });
    return rings_.finish(threads);
}

Spectrum analyse_lights(const PointLights& lights, std::shared_ptr<const RingTransform> with, int threads) {
    ScatterAnalysis analysis(std::move(with));
    std::vector<SphereGrid> grids;
    grids.emplace_back(analysis.grid());
    const int count = lights.count();
    std::vector<double> x(lights.x.begin(), lights.x.end()), y(lights.y.begin(), lights.y.end()),
        z(lights.z.begin(), lights.z.end());
    std::vector<float> rgb(3 * std::size_t(count));
    for (int i = 0; i < count; ++i)
        rgb[3 * i] = lights.r[i], rgb[3 * i + 1] = lights.g[i], rgb[3 * i + 2] = lights.b[i];
    simd::scatter_directions(grids[0].view(), grids[0].ring(0), analysis.table(), x.data(), y.data(), z.data(), count,
                             rgb.data());
    return analysis.finish(grids, threads);
}

}  // namespace domelight
