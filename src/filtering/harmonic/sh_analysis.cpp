#include "filtering/harmonic/sh_analysis.h"

#include "domelight/base/parallel.h"
#include "domelight/base/vec.h"

#include "base/interpolation_taps.h"
#include "filtering/harmonic/row_kernels.h"

#include <algorithm>
#include <cassert>

namespace domelight {
namespace {

constexpr int k_batch = RingAnalysis::k_batch;
constexpr int k_batches_at_once = 4;

/// 2 pi / W sinc^2(m / W) e^{-i m phi_0}: the transform of the tents, from the first texel's centre on.
std::vector<std::complex<double>> tent_factors(int width, int band_limit) {
    std::vector<std::complex<double>> factors(band_limit + 1);
    const double phi0 = 2 * k_pi * (0.5 / width - 0.5);
    for (int m = 0; m <= band_limit; ++m) {
        const double x = k_pi * m / width, sinc = m ? std::sin(x) / x : 1;
        factors[m] = std::polar(2 * k_pi / width * sinc * sinc, -m * phi0);
    }
    return factors;
}

}  // namespace

ShAnalysis::ShAnalysis(int width, int height, int band_limit, int threads)
    : width_(width),
      height_(height),
      threads_(threads),
      rings_(width, band_limit, tent_factors(width, band_limit)),
      reduction_(height, rings_.grid().rings, double(band_limit) / rings_.grid().rings, k_filtered_decay) {}

void ShAnalysis::add_rows(ImageView<const float> rows) {
    assert(rows.width == width_ && rows.channels == 3 && next_row_ + rows.height <= height_);
    const int first = next_row_, end = next_row_ + rows.height;
    std::vector<int> touched;
    std::vector<float*> fresh;  // batches to be cleared first
    for (int k = next_batch_ * k_batch; k < reduction_.count(); ++k) {
        const auto& row = reduction_.row(k);
        if (row.first >= end || row.end() <= first) continue;
        touched.push_back(k);
        AlignedArray<float>& batch = open_[k / k_batch];
        if (batch.size()) continue;
        if (spare_.empty()) spare_.emplace_back(std::size_t(k_batch) * 3 * width_, false);
        batch = std::move(spare_.back());
        spare_.pop_back();
        fresh.push_back(batch.data());
    }
    // Columns are independent. A tile of the image's rows stays in the cache while it is added to every ring row.
    constexpr int tile = 192;
    const int columns = 3 * width_;
    parallel_ranges(columns, tile, threads_, [&](int begin, int stop) {
        for (float* batch : fresh)
            for (int row = 0; row < k_batch; ++row)
                std::fill(batch + row * columns + begin, batch + row * columns + stop, 0.f);
        for (int k : touched) {
            const auto& row = reduction_.row(k);
            const int from = std::max(row.first, first), to = std::min(row.end(), end);
            float* sum = open_.find(k / k_batch)->second.data() + std::size_t(k % k_batch) * std::size_t(columns);
            simd::add_weighted_rows(rows.row(from - first) + begin, rows.stride,
                                    row.weights.data() + (from - row.first), to - from, sum + begin, stop - begin);
        }
    });
    next_row_ = end;
    transform_finished(end);
}

/// Transforms the batches that are complete.
void ShAnalysis::transform_finished(int next_row) {
    int end = next_batch_;
    for (; end < rings_.batch_count(); ++end) {
        bool finished = true;
        for (int k = end * k_batch; k < std::min((end + 1) * k_batch, reduction_.count()); ++k)
            finished &= reduction_.row(k).end() <= next_row;
        if (!finished) break;
    }
    const int first = next_batch_;
    // There are three channels in a batch: several batches at a time keep all threads busy.
    if (end - first < k_batches_at_once && end < rings_.batch_count()) return;
    parallel_for(3 * (end - first), threads_, [&](int task) {
        const int index = first + task / 3;
        const auto batch = open_.find(index);
        if (batch != open_.end())
            rings_.transform(batch->second.data(), 3 * std::ptrdiff_t(width_), 3, index, task % 3);
    });
    for (int index = first; index < end; ++index)
        if (const auto batch = open_.find(index); batch != open_.end()) {
            spare_.push_back(std::move(batch->second));
            open_.erase(batch);
        }
    next_batch_ = end;
}

Spectrum ShAnalysis::finish() {
    assert(next_row_ == height_);
    return rings_.finish(threads_);
}

Spectrum analyse_texels(int width, int height, std::span<const LoneTexel> texels, int band_limit, int threads) {
    RingAnalysis rings(width, band_limit, tent_factors(width, band_limit));
    const LatitudeReduction reduction(height, rings.grid().rings, double(band_limit) / rings.grid().rings,
                                      k_filtered_decay);
    rings.clear();
    std::vector<std::complex<double>> orders(3 * std::size_t(band_limit + 1));
    for (std::size_t i = 0; i < texels.size();) {
        const int y = texels[i].y;
        std::fill(orders.begin(), orders.end(), 0);
        for (; i < texels.size() && texels[i].y == y; ++i)
            for (int m = 0; m <= band_limit; ++m) {
                // Whole turns are removed from m x / W in integers, so there is no rounding.
                const double turns = double(std::int64_t(m) * texels[i].x % width) / width;
                const std::complex<double> wave = std::polar(1.0, -2 * k_pi * turns);
                for (int c = 0; c < 3; ++c) orders[3 * m + c] += double(texels[i].rgb[c]) * wave;
            }
        for (int k = 0; k < reduction.count(); ++k) {
            const auto& row = reduction.row(k);
            if (row.first <= y && y < row.end()) rings.add_orders(k, row.weights[y - row.first], orders);
        }
    }
    return rings.finish(threads);
}

}  // namespace domelight
