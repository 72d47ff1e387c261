#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace domelight {

namespace simd {

/// A run of pixels that follow each other.
struct PixelRun {
    std::int32_t first, count;
};

/// out[i * out_stride + c] = sum of weight * pixels[pixel * channels + c] over the runs first_run[i] .. first_run[i + 1] - 1,
/// i < count. The weights of all runs follow each other; those of point i begin at first_weight[i].
///
/// channels   12 or 24
void weigh_pixels(const float* pixels, int channels, const PixelRun* runs, const std::int32_t* first_run,
                  const float* weights, const std::int32_t* first_weight, int count, float* out,
                  std::ptrdiff_t out_stride);

}  // namespace simd

/// A sparse matrix that takes pixels to points: each point is a weighted sum of a few pixels.
class SparsePixels {
  public:
    explicit SparsePixels(int points) : entries_(std::size_t(points)) {}

    /// Adds to the weight of a pixel in a point. Of each point, pixels come in rising order.
    void add(int point, int pixel, double weight) {
        auto& of_point = entries_[std::size_t(point)];
        if (of_point.empty() || of_point.back().pixel != pixel) of_point.push_back({pixel, 0});
        of_point.back().weight += weight;
    }
    /// Once, after the last add().
    void finish();

    int points() const { return int(first_run_.size()) - 1; }
    /// The points begin .. end - 1.
    void apply(const float* pixels, int channels, int begin, int end, float* out, std::ptrdiff_t out_stride) const {
        simd::weigh_pixels(pixels, channels, runs_.data(), first_run_.data() + begin, weights_.data(),
                           first_weight_.data() + begin, end - begin, out, out_stride);
    }

  private:
    struct Entry {
        int pixel;
        double weight;
    };
    std::vector<std::vector<Entry>> entries_;  ///< of each point, until finish()
    std::vector<simd::PixelRun> runs_;
    std::vector<std::int32_t> first_run_, first_weight_;
    std::vector<float> weights_;
};

}  // namespace domelight
