#include "filtering/harmonic/batch_fft.h"

#include "base/instruction_set.h"
#include "test.h"

#include <hwy/aligned_allocator.h>

#include <complex>
#include <numbers>

using domelight::simd::BatchFft;
using domelight::simd::k_fft_lanes;

namespace {

/// The transform of one sequence by its definition, in double.
std::vector<std::complex<double>> plain_dft(const std::vector<std::complex<double>>& x, int sign) {
    const int n = int(x.size());
    std::vector<std::complex<double>> y(n);
    for (int f = 0; f < n; ++f)
        for (int i = 0; i < n; ++i)
            y[f] += x[i] * std::polar(1.0, sign * 2 * std::numbers::pi * (std::int64_t(f) * i % n) / n);
    return y;
}

}  // namespace

TEST_CASE("batch_fft: forward and inverse agree with the definition, for every kind of length") {
    for (const char* set : {"", "AVX2", "SSE4", "SCALAR"}) {
        domelight::simd::limit_instruction_set(set);
        for (int n : {1, 2, 3, 4, 5, 6, 7, 8, 12, 15, 16, 22, 60, 64, 77, 96, 128, 182, 250, 1000, 1018}) {
            const BatchFft fft(n);
            auto data = hwy::AllocateAligned<float>(std::size_t(n) * 2 * k_fft_lanes);
            std::vector<std::vector<std::complex<double>>> x(k_fft_lanes, std::vector<std::complex<double>>(n));
            unsigned state = 1;
            const auto next = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24) - 0.5f; };
            for (int i = 0; i < n; ++i)
                for (int lane = 0; lane < k_fft_lanes; ++lane) {
                    const float re = next(), im = next();
                    x[lane][i] = {re, im};
                    data[i * 2 * k_fft_lanes + lane] = re;
                    data[(i * 2 + 1) * k_fft_lanes + lane] = im;
                }
            fft.forward(data.get());
            double worst = 0;
            for (int lane : {0, 7, 15}) {
                const auto y = plain_dft(x[lane], -1);
                for (int f = 0; f < n; ++f) {
                    const float* at = data.get() + std::size_t(fft.position(f)) * 2 * k_fft_lanes + lane;
                    worst = std::max(worst, std::abs(y[f] - std::complex<double>(at[0], at[k_fft_lanes])));
                }
            }
            CHECK_MESSAGE(worst < 3e-7 * std::sqrt(n) * (2 + std::log2(n)), "forward, n = " << n << " on " << set);
            fft.inverse(data.get());
            worst = 0;
            for (int i = 0; i < n; ++i)
                for (int lane = 0; lane < k_fft_lanes; ++lane) {
                    const float* at = data.get() + std::size_t(i) * 2 * k_fft_lanes + lane;
                    worst = std::max(worst,
                                     std::abs(x[lane][i] - std::complex<double>(at[0], at[k_fft_lanes]) / double(n)));
                }
            CHECK_MESSAGE(worst < 3e-7 * (2 + std::log2(n)), "round trip, n = " << n << " on " << set);
        }
    }
    domelight::simd::limit_instruction_set("");
}
