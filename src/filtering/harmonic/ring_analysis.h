#pragma once

#include "filtering/harmonic/latitude_reduction.h"
#include "filtering/harmonic/ring_transform.h"
#include "filtering/harmonic/spectrum.h"

#include <complex>
#include <memory>
#include <span>

namespace domelight {

/// The second half of an analysis. It turns rows on the rings of a grid (including those beyond the poles), each
/// already weighted with its share of the sphere, into spherical-harmonic coefficients: the sum of P_lm e^{-i m phi}
/// over rings and points.
class RingAnalysis {
  public:
    /// The number of rows that are transformed together.
    static constexpr int k_batch = 2 * simd::k_fft_lanes;
    static constexpr int k_pad = LatitudeReduction::k_pad;

    /// `order_factors`: the factor of each order m = 0..band_limit.
    RingAnalysis(std::shared_ptr<const RingTransform> with, std::vector<std::complex<double>> order_factors);
    RingAnalysis(int width, int band_limit, std::vector<std::complex<double>> order_factors)
        : RingAnalysis(std::make_shared<RingTransform>(width, band_limit), std::move(order_factors)) {}

    const RingGrid& grid() const { return with_->grid; }
    int row_count() const { return grid().rings + 2 * k_pad; }
    int batch_count() const { return (row_count() + k_batch - 1) / k_batch; }
    /// Adds one channel of the rows 32 batch .. 32 batch + 31 (ring = row - k_pad). Different batches and channels may
    /// be added at the same time. rows: `stride` floats apart, texels `texel` floats apart.
    void transform(const float* rows, std::ptrdiff_t stride, int texel, int batch, int channel);
    /// In place of transform() of all channels: the rows of a batch are black.
    void clear(int batch);
    /// An alternative for a few nearly empty rows: adds `weight` times a row's Fourier coefficients, orders[3 m +
    /// channel] = sum_x g e^{-2 pi i m x / W}, m = 0..band_limit. After clear().
    void clear() { rings_.fill_zero(); }
    void add_orders(int row, double weight, std::span<const std::complex<double>> orders);
    /// Once, after all rows.
    Spectrum finish(int threads);

  private:
    std::shared_ptr<const RingTransform> with_;
    std::vector<std::complex<double>> order_factors_;
    int stride_;
    AlignedArray<float> rings_;  ///< [m][channel, re | im][row]
};

}  // namespace domelight
