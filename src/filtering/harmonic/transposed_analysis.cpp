#include "filtering/harmonic/transposed_analysis.h"

#include "domelight/base/parallel.h"
#include "domelight/base/vec.h"

#include "base/aligned.h"
#include "base/interpolation_taps.h"
#include "filtering/harmonic/batch_fft.h"
#include "filtering/harmonic/latitude_reduction.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace domelight {
namespace {

constexpr int k_lanes = simd::k_fft_lanes, k_rows = 2 * k_lanes;

/// The tents' transform for each order -band_limit .. band_limit, over the number of points of a ring:
///   2 pi / W sinc²(m / W) e^{i m phi_0} / n, with phi_0 the first texel's centre.
std::vector<std::complex<float>> tent_factors(int width, int ring_width, int band_limit) {
    std::vector<std::complex<float>> factors(2 * std::size_t(band_limit) + 1);
    const double phi0 = 2 * k_pi * (0.5 / width - 0.5);
    for (int m = -band_limit; m <= band_limit; ++m) {
        const double x = k_pi * m / width, sinc = m ? std::sin(x) / x : 1;
        factors[std::size_t(m + band_limit)] =
            std::complex<float>(std::polar(2 * k_pi / width * sinc * sinc / ring_width, m * phi0));
    }
    return factors;
}

/// Integrals over tents along rings. Each ring gives a row of the image's width.
class RingTents {
  public:
    RingTents(const SphereGrid& function, int band_limit, int width)
        : function_(function),
          band_limit_(band_limit),
          width_(width),
          ring_fft_(function.grid().width),
          row_fft_(width),
          factors_(tent_factors(width, function.grid().width, band_limit)) {}

    /// Rings first .. first + count - 1 (at most 32) of one channel. Two rings share a lane, as real and imaginary part:
    /// the tents are real.
    void rows(int first, int count, int channel, float* out, std::ptrdiff_t stride) const {
        AlignedArray<float> rings(std::size_t(ring_fft_.size()) * k_rows), texels(std::size_t(width_) * k_rows);
        for (int r = 0; r < count; ++r) {
            const float* from = function_.ring(first + r) + channel;
            for (int i = 0; i < ring_fft_.size(); ++i) rings.data()[std::size_t(i) * k_rows + r] = from[4 * i];
        }
        ring_fft_.forward(rings.data());
        for (int m = -band_limit_; m <= band_limit_; ++m) add_order(m, rings.data(), texels.data());
        row_fft_.inverse(texels.data());
        for (int r = 0; r < count; ++r)
            for (int x = 0; x < width_; ++x) out[r * stride + 3 * x] = texels.data()[std::size_t(x) * k_rows + r];
    }

  private:
    /// Orders beyond half the image's width fold back: texels do not tell them from lower ones.
    void add_order(int m, const float* rings, float* texels) const {
        const auto place = [](int order, int n) { return (order % n + n) % n; };
        const float* from = rings + std::size_t(ring_fft_.position(place(m, ring_fft_.size()))) * k_rows;
        float* to = texels + std::size_t(row_fft_.position(place(m, width_))) * k_rows;
        const std::complex<float> factor = factors_[std::size_t(m + band_limit_)];
        const float c = factor.real(), s = factor.imag();
        for (int k = 0; k < k_lanes; ++k) {
            to[k] += c * from[k] - s * from[k_lanes + k];
            to[k_lanes + k] += c * from[k_lanes + k] + s * from[k];
        }
    }

    const SphereGrid& function_;
    int band_limit_, width_;
    simd::BatchFft ring_fft_, row_fft_;
    std::vector<std::complex<float>> factors_;
};

}  // namespace

void add_tent_integrals(const SphereGrid& function, int band_limit, ImageView<float> image, int threads) {
    constexpr int pad = LatitudeReduction::k_pad;
    const int rings = function.grid().rings, rows = rings + 2 * pad, columns = 3 * image.width;
    const RingTents tents(function, band_limit, image.width);
    const LatitudeReduction reduction(image.height, rings, double(band_limit) / rings, k_filtered_decay);
    auto along = ImageF::uninitialized(image.width, rows, 3);
    const int batches = (rows + k_rows - 1) / k_rows;
    parallel_for(3 * batches, threads, [&](int task) {
        const int first = task / 3 * k_rows;
        tents.rows(first - pad, std::min(k_rows, rows - first), task % 3, along.row(first) + task % 3, columns);
    });
    constexpr int tile = 192;
    parallel_ranges(columns, tile, threads, [&](int begin, int end) {
        for (int k = 0; k < rows; ++k) {
            const LatitudeReduction::Row& row = reduction.row(k);
            const float* from = along.row(k);
            for (int j = row.first; j < row.end(); ++j) {
                const float weight = row.weights[std::size_t(j - row.first)];
                float* to = image.row(j);
                for (int x = begin; x < end; ++x) to[x] += weight * from[x];
            }
        }
    });
}

}  // namespace domelight
