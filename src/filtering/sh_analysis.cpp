#include "filtering/sh_analysis.h"

#include <cassert>

#include "domelight/parallel.h"
#include "domelight/vec.h"
#include "simd/row_kernels.h"

namespace domelight {
namespace {

constexpr int k_batch = 2 * simd::k_fft_lanes;
constexpr int k_pad = LatitudeReduction::k_pad;
/// The least decay of a filtered spectrum at the band limit: see InterpolationTaps.
constexpr double k_decay = 16;

int batch_count(int rows) { return (rows + k_batch - 1) / k_batch; }

}  // namespace

ShAnalysis::ShAnalysis(int width, int height, int band_limit, int threads)
    : width_(width), height_(height), band_limit_(band_limit), threads_(threads), grid_(ring_grid_for(band_limit)),
      reduction_(height, grid_.rings, double(band_limit) / grid_.rings, k_decay), fft_(width), order_factor_(band_limit + 1),
      ring_stride_(batch_count(reduction_.count()) * k_batch), rings_(std::size_t(band_limit + 1) * 6 * ring_stride_, false) {
    const double phi0 = 2 * k_pi * (0.5 / width - 0.5);  // of the first texel's centre
    for (int m = 0; m <= band_limit; ++m) {
        const double x = k_pi * m / width, sinc = m ? std::sin(x) / x : 1;
        order_factor_[m] = std::polar(2 * k_pi / width * sinc * sinc, -m * phi0);
    }
}

void ShAnalysis::add_rows(ImageView<const float> rows) {
    assert(rows.width == width_ && rows.channels == 3 && next_row_ + rows.height <= height_);
    const int first = next_row_, end = next_row_ + rows.height;
    std::vector<int> touched;
    for (int k = next_batch_ * k_batch; k < reduction_.count(); ++k) {
        const auto& row = reduction_.row(k);
        if (row.first >= end || row.end() <= first) continue;
        touched.push_back(k);
        Batch& batch = open_[k / k_batch];
        if (!batch.rows.size()) batch.rows = AlignedArray<float>(std::size_t(k_batch) * 3 * width_);
    }
    // Columns are independent. A tile of the image's rows stays in cache while every ring row takes its share.
    constexpr int tile = 192;
    const int columns = 3 * width_;
    parallel_ranges(columns, tile, threads_, [&](int begin, int stop) {
        for (int k : touched) {
            const auto& row = reduction_.row(k);
            const int from = std::max(row.first, first), to = std::min(row.end(), end);
            float* sum = open_.find(k / k_batch)->second.rows.data() + std::size_t(k % k_batch) * columns;
            simd::add_weighted_rows(rows.row(from - first) + begin, rows.stride, row.weights.data() + (from - row.first), to - from, sum + begin,
                                    stop - begin);
        }
    });
    next_row_ = end;
    transform_finished(end);
}

/// Transforms the batches that no later row adds to.
void ShAnalysis::transform_finished(int next_row) {
    const int batches = batch_count(reduction_.count());
    int end = next_batch_;
    for (; end < batches; ++end) {
        bool finished = true;
        for (int k = end * k_batch; k < std::min((end + 1) * k_batch, reduction_.count()); ++k) finished &= reduction_.row(k).end() <= next_row;
        if (!finished) break;
    }
    const int first = next_batch_;
    parallel_for(3 * (end - first), threads_, [&](int task) {
        const int index = first + task / 3;
        const auto batch = open_.find(index);
        if (batch != open_.end()) transform(batch->second, index, task % 3);
    });
    for (int index = first; index < end; ++index) open_.erase(index);
    next_batch_ = end;
}

/// Two real rows a lane, as real and imaginary part: X = A + iB gives A_m = (X_m + conj X_-m) / 2, B_m = (X_m - conj X_-m) / 2i.
void ShAnalysis::transform(const Batch& batch, int index, int channel) {
    AlignedArray<float> data(std::size_t(width_) * k_batch, false);
    simd::gather_fft_rows(batch.rows.data(), 3 * std::ptrdiff_t(width_), channel, width_, data.data());
    fft_.forward(data.data());
    for (int m = 0; m <= band_limit_; ++m) {
        const int f = m % width_;
        const float* plus = data.data() + std::size_t(fft_.position(f)) * k_batch;
        const float* minus = data.data() + std::size_t(fft_.position((width_ - f) % width_)) * k_batch;
        float* re = rings_.data() + (std::size_t(m) * 6 + 2 * channel) * ring_stride_ + std::size_t(index) * k_batch;
        float* im = re + ring_stride_;
        const float c = float(0.5 * order_factor_[m].real()), s = float(0.5 * order_factor_[m].imag());
        for (int i = 0; i < simd::k_fft_lanes; ++i) {
            const float pr = plus[i], pi = plus[i + simd::k_fft_lanes], mr = minus[i], mi = minus[i + simd::k_fft_lanes];
            const float ar = pr + mr, ai = pi - mi, br = pi + mi, bi = mr - pr;
            re[i] = ar * c - ai * s;
            im[i] = ar * s + ai * c;
            re[i + simd::k_fft_lanes] = br * c - bi * s;
            im[i + simd::k_fft_lanes] = br * s + bi * c;
        }
    }
}

Spectrum ShAnalysis::finish() {
    assert(next_row_ == height_);
    const NorthernRings north(grid_.rings);
    Spectrum spectrum(band_limit_);
    const int rings = grid_.rings;
    constexpr int orders_at_once = 4;
    parallel_ranges(band_limit_ + 1, orders_at_once, threads_, [&](int begin, int end) {
        LegendreWalk walk(north, band_limit_);
        AlignedArray<float> even_odd(12 * std::size_t(north.padded));
        for (int m = begin; m < end; ++m) {
            const float turned = m % 2 ? -1.f : 1.f;  // half a turn multiplies order m by (-1)^m
            for (int c = 0; c < 6; ++c) {
                float* ring = rings_.data() + (std::size_t(m) * 6 + c) * ring_stride_ + k_pad;
                for (int k = 0; k < k_pad; ++k) {
                    ring[k] += turned * ring[-1 - k];
                    ring[rings - 1 - k] += turned * ring[rings + k];
                }
                float *even = even_odd.data() + std::size_t(c) * north.padded, *odd = even + 6 * std::size_t(north.padded);
                for (int k = 0; k < north.count; ++k) {
                    even[k] = ring[k] + ring[rings - 1 - k];
                    odd[k] = ring[k] - ring[rings - 1 - k];
                }
            }
            for (int parity = 0; parity < 2; ++parity) {
                float* block = spectrum.block(m, parity);
                const float* data = even_odd.data() + std::size_t(parity) * 6 * north.padded;
                walk.walk(m, parity, [&](int first, int count, int first_ring, const float* p) {
                    simd::project_rows(p + first_ring, north.padded, count, data + first_ring, north.padded, north.padded - first_ring,
                                       block + 6 * first);
                });
                if (const int count = spectrum.block_count(m, parity); count > 0 && m + parity + 2 * (count - 1) > band_limit_)
                    std::fill_n(block + 6 * (count - 1), 6, 0.f);
            }
        }
    });
    return spectrum;
}

}  // namespace domelight
