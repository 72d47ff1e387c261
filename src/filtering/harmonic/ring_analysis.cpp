#include "filtering/harmonic/ring_analysis.h"

#include "domelight/base/parallel.h"

#include "filtering/harmonic/row_kernels.h"

#include <algorithm>

namespace domelight {

RingAnalysis::RingAnalysis(std::shared_ptr<const RingTransform> with, std::vector<std::complex<double>> order_factors)
    : with_(std::move(with)),
      order_factors_(std::move(order_factors)),
      stride_(batch_count() * k_batch),
      rings_(std::size_t(with_->band_limit + 1) * 6 * stride_, false) {}

/// Two real rows a lane, as real and imaginary part: X = A + iB gives A_m = (X_m + conj X_-m) / 2, B_m = (X_m - conj
/// X_-m) / 2i.
void RingAnalysis::transform(const float* rows, std::ptrdiff_t stride, int texel, int batch, int channel) {
    const simd::BatchFft& fft = with_->fft;
    const int width = fft.size();
    AlignedArray<float> data(std::size_t(width) * k_batch, false);
    simd::gather_fft_rows(rows + channel, stride, texel, width, data.data());
    fft.forward(data.data());
    for (int m = 0; m <= with_->band_limit; ++m) {
        const int f = m % width;
        const float* plus = data.data() + std::size_t(fft.position(f)) * k_batch;
        const float* minus = data.data() + std::size_t(fft.position((width - f) % width)) * k_batch;
        float* re = rings_.data() + (std::size_t(m) * 6 + 2 * channel) * stride_ + std::size_t(batch) * k_batch;
        float* im = re + stride_;
        const float c = float(0.5 * order_factors_[m].real()), s = float(0.5 * order_factors_[m].imag());
        simd::unpack_orders(plus, minus, c, s, re, im);
    }
}

void RingAnalysis::clear(int batch) {
    for (int row = 0; row < 6 * (with_->band_limit + 1); ++row)
        std::fill_n(rings_.data() + std::size_t(row) * stride_ + std::size_t(batch) * k_batch, k_batch, 0.f);
}

void RingAnalysis::add_orders(int row, double weight, std::span<const std::complex<double>> orders) {
    for (int m = 0; m <= with_->band_limit; ++m)
        for (int c = 0; c < 3; ++c) {
            const std::complex<double> value = weight * order_factors_[m] * orders[3 * m + c];
            float* re = rings_.data() + (std::size_t(m) * 6 + 2 * c) * stride_ + row;
            re[0] += float(value.real());
            re[stride_] += float(value.imag());
        }
}

Spectrum RingAnalysis::finish(int threads) {
    const NorthernRings& north = with_->north;
    const int band_limit = with_->band_limit, rings = grid().rings;
    Spectrum spectrum(band_limit);
    constexpr int orders_at_once = 4;
    const auto project_orders = [&](auto& walk, int begin, int end) {
        AlignedArray<float> even_odd(12 * std::size_t(north.padded));
        for (int m = begin; m < end; ++m) {
            const float turned = m % 2 ? -1.f : 1.f;  // half a turn multiplies order m by (-1)^m
            for (int c = 0; c < 6; ++c) {
                float* ring = rings_.data() + (std::size_t(m) * 6 + c) * stride_ + k_pad;
                for (int k = 0; k < k_pad; ++k) {
                    ring[k] += turned * ring[-1 - k];
                    ring[rings - 1 - k] += turned * ring[rings + k];
                }
                float *even = even_odd.data() + std::size_t(c) * north.padded,
                      *odd = even + 6 * std::size_t(north.padded);
                for (int k = 0; k < north.count; ++k) {
                    even[k] = ring[k] + ring[rings - 1 - k];
                    odd[k] = ring[k] - ring[rings - 1 - k];
                }
            }
            for (int parity = 0; parity < 2; ++parity) {
                float* block = spectrum.block(m, parity);
                const float* data = even_odd.data() + std::size_t(parity) * 6 * north.padded;
                walk.walk(m, parity, [&](int first, int count, int first_ring, const float* p) {
                    simd::project_rows(p + first_ring, north.padded, count, data + first_ring, north.padded,
                                       north.padded - first_ring, block + 6 * first);
                });
                if (const int count = spectrum.block_count(m, parity);
                    count > 0 && m + parity + 2 * (count - 1) > band_limit)
                    std::fill_n(block + 6 * (count - 1), 6, 0.f);
            }
        }
    };
    parallel_ranges(band_limit + 1, orders_at_once, threads,
                    [&](int begin, int end) { with_->with_legendre(begin, end, project_orders); });
    return spectrum;
}

}  // namespace domelight
