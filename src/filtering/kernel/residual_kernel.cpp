#include "filtering/kernel/residual_kernel.h"

#include "domelight/base/parallel.h"
#include "domelight/base/vec.h"

#include <cmath>

namespace domelight {

ResidualKernels::ResidualKernels(std::span<const ZonalKernel> kernels, std::span<const std::vector<double>> factors,
                                 int threads) {
    const int band_limit = int(factors[0].size()) - 1, n = int(kernels.size());
    // 32 steps for each wave of the first truncated degree: linear interpolation is then off by (pi / 16)^2 / 8, half a
    // per cent of a term that is itself about a per cent.
    steps_ = 16 * (band_limit + 1);
    values_.resize(std::size_t(n) * (steps_ + 2));
    parallel_ranges(steps_ + 1, 512, threads, [&](int begin, int end) {
        const int points = end - begin;
        std::vector<double> cosine(points), p(points, 1.0), p_prev(points, 0.0), sum(std::size_t(n) * points, 0.0);
        for (int i = 0; i < points; ++i) cosine[i] = std::cos(k_pi * (begin + i) / steps_);
        for (int l = 0; l <= band_limit; ++l) {
            for (int k = 0; k < n; ++k) {
                const double factor = (2 * l + 1) / (4 * k_pi) * factors[k][l];
                double* s = sum.data() + std::size_t(k) * points;
                for (int i = 0; i < points; ++i) s[i] += factor * p[i];
            }
            const double a = (2 * l + 1.0) / (l + 1), b = l / (l + 1.0);
            for (int i = 0; i < points; ++i) {
                const double next = a * cosine[i] * p[i] - b * p_prev[i];
                p_prev[i] = p[i];
                p[i] = next;
            }
        }
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < points; ++i)
                values_[std::size_t(k) * (steps_ + 2) + begin + i] =
                    float(kernels[k].density(k_pi * (begin + i) / steps_) - sum[std::size_t(k) * points + i]);
    });
    for (int k = 0; k < n; ++k) {
        float* out = values_.data() + std::size_t(k) * (steps_ + 2);
        out[steps_ + 1] = out[steps_];
    }
}

}  // namespace domelight
