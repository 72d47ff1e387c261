#include "filtering/resample/area_resample_latlong.h"

#include "domelight/base/parallel.h"

#include "filtering/resample/area_resample_plain.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight::area {

bool keeps_polar_axis(const AlignedOrientation& orientation) {
    return std::abs(orientation.axes.row[1].y) > 0.5;
}

namespace {

/// The source rows or columns that one output row or column averages: weights that sum to 1, from `first` on (columns
/// wrap).
struct Taps {
    int first = 0;
    std::vector<float> weights;
};

/// Columns: the tents of the nodes 0, 1, ... averaged over [a, b].
Taps column_taps(double a, double b) {
    const int first = int(std::floor(a)), last = int(std::ceil(b));
    std::vector<double> weights(last - first + 1, 0.0);
    for (int n = first; n < last; ++n) {
        const double from = std::max(a, double(n)) - n, to = std::min(b, n + 1.0) - n, width = to - from;
        const double right = width * 0.5 * (from + to);
        weights[n - first] += width - right;
        weights[n - first + 1] += right;
    }
    Taps taps{first, {}};
    for (double w : weights) taps.weights.push_back(float(w / (b - a)));
    return taps;
}

/// Rows: the tents of the rows of texel centres averaged over theta in [a, b] with sin theta.
Taps row_taps(double a, double b, int height) {
    const double h = k_pi / height;
    const int first = std::clamp(int(std::floor(a / h - 0.5)), -1, height - 1),
              last = std::clamp(int(std::ceil(b / h - 0.5)), 0, height);
    std::vector<double> weights(last - first + 1, 0.0);
    double sum = 0;
    for (int j = first; j < last; ++j) {
        const double from = std::max({a, (j + 0.5) * h, 0.0}), to = std::min({b, (j + 1.5) * h, k_pi});
        if (to <= from) continue;
        const SineMoments m = sine_moments(from, to);
        const double lower = m.first / h + (from / h - (j + 0.5)) * m.zeroth;
        weights[j - first] += m.zeroth - lower;
        weights[j + 1 - first] += lower;
        sum += m.zeroth;
    }
    // Rows -1 and H are rows 0 and H - 1 again.
    Taps taps{std::max(first, 0), {}};
    taps.weights.assign(std::min(last, height - 1) - taps.first + 1, 0.0f);
    std::vector<double> folded(taps.weights.size(), 0.0);
    for (int j = first; j <= last; ++j) folded[std::clamp(j, 0, height - 1) - taps.first] += weights[j - first];
    for (std::size_t k = 0; k < folded.size(); ++k) taps.weights[k] = float(std::max(0.0, folded[k] / sum));
    return taps;
}

class LatlongResampler : public AreaResampler {
  public:
    LatlongResampler(int width, int height, int out_height, const AlignedOrientation& orientation, int threads)
        : width_(width), height_(height), threads_(threads), out_(2 * out_height, out_height, 3) {
        const Mat3& axes = orientation.axes;
        // Source azimuth = sign * world azimuth + start.
        const double sign = axes.row[0].x * axes.row[2].z - axes.row[0].z * axes.row[2].x;
        const double start = std::atan2(axes.row[2].x, axes.row[0].x) + orientation.angle;
        const int out_width = out_.width();
        for (int x = 0; x < out_width; ++x) {
            const auto column = [&](double u) { return (sign * (u - 0.5) + start / (2 * k_pi) + 0.5) * width - 0.5; };
            const double a = column(double(x) / out_width), b = column(double(x + 1) / out_width);
            columns_.push_back(column_taps(std::min(a, b), std::max(a, b)));
        }
        const bool upside_down = axes.row[1].y < 0;
        int span = 1;
        for (int k = 0; k < out_height; ++k) {  // in the order of the source's rows
            const int y = upside_down ? out_height - 1 - k : k;
            rows_.push_back({y, row_taps(k_pi * k / out_height, k_pi * (k + 1) / out_height, height)});
            span = std::max(span, int(rows_.back().taps.weights.size()));
        }
        across_ = ImageF(out_width, span + k_batch, 3);
    }

    void add_rows(ImageView<const float> rows) override {
        assert(rows.width == width_ && rows.channels == 3 && received_ + rows.height <= height_);
        for (int y = 0; y < rows.height;) {
            const int count = std::min(rows.height - y, k_batch);
            process(rows.rows(y, count));
            y += count;
        }
    }

    ImageF finish() override {
        assert(received_ == height_ && next_ == rows_.size());
        return std::move(out_);
    }

  private:
    static constexpr int k_batch = 32;
    struct OutRow {
        int y;
        Taps taps;
    };

    /// Averages the new rows along the columns, and finishes the output rows whose source rows have all been read.
    void process(ImageView<const float> rows) {
        const int from = received_;
        received_ += rows.height;
        std::size_t ready = next_;
        while (ready < rows_.size() && rows_[ready].taps.first + int(rows_[ready].taps.weights.size()) <= received_)
            ++ready;
        const bool few = std::int64_t(rows.height) * out_.width() < 1 << 14;
        parallel_ranges(out_.width(), 64, few ? 1 : threads_, [&](int begin, int end) {
            for (int y = 0; y < rows.height; ++y)
                average_columns(rows.row(y), across_.row((from + y) % across_.height()), begin, end);
            for (std::size_t k = next_; k < ready; ++k) average_rows(rows_[k], begin, end);
        });
        next_ = ready;
    }

    void average_columns(const float* row, float* to, int begin, int end) const {
        for (int x = begin; x < end; ++x) {
            const Taps& taps = columns_[x];
            int column = ((taps.first % width_) + width_) % width_;
            double sum[3] = {};
            for (const float w : taps.weights) {
                for (int c = 0; c < 3; ++c) sum[c] += double(w) * row[3 * std::ptrdiff_t(column) + c];
                if (++column == width_) column = 0;
            }
            for (int c = 0; c < 3; ++c) to[3 * x + c] = float(sum[c]);
        }
    }

    void average_rows(const OutRow& row, int begin, int end) {
        float* to = out_.row(row.y);
        for (int k = 3 * begin; k < 3 * end; ++k) {
            double sum = 0;
            for (std::size_t r = 0; r < row.taps.weights.size(); ++r)
                sum += double(row.taps.weights[r]) * across_.row((row.taps.first + int(r)) % across_.height())[k];
            to[k] = float(sum);
        }
    }

    int width_, height_, threads_, received_ = 0;
    std::vector<Taps> columns_;
    std::vector<OutRow> rows_;
    std::size_t next_ = 0;
    ImageF across_;  ///< the latest source rows, averaged to the output's columns; row j at j modulo its height
    ImageF out_;
};

}  // namespace

std::unique_ptr<AreaResampler> aligned_to_latlong(int width, int height, int out_height,
                                                  const AlignedOrientation& orientation, int threads) {
    assert(keeps_polar_axis(orientation));
    return std::make_unique<LatlongResampler>(width, height, out_height, orientation, threads);
}

}  // namespace domelight::area
