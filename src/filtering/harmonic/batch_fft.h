#pragma once

#include <vector>

namespace domelight::simd {

/// The number of sequences that are transformed together.
inline constexpr int k_fft_lanes = 16;

/// Complex discrete Fourier transforms of any length n, of 16 sequences at once: element i of all sequences is stored
/// together, 16 real parts and then 16 imaginary parts (so data holds n * 32 floats). Mixed radix, in place, without
/// reordering: frequency f of the result lies at position(f).
class BatchFft {
  public:
    explicit BatchFft(int n);

    int size() const { return n_; }
    /// Where frequency f, 0 <= f < n, lies in the transformed data.
    int position(int f) const { return position_[f]; }
    /// X_f = sum_i x_i exp(-2 pi sqrt(-1) f i / n); natural order in, position() order out.
    void forward(float* data) const;
    /// x_i = sum_f X_f exp(+2 pi sqrt(-1) f i / n); position() order in, natural order out. Not divided by n.
    void inverse(float* data) const;

    const std::vector<int>& radices() const { return radices_; }
    /// exp(-2 pi sqrt(-1) k / n), k = 0..n-1, as (cos, sin) pairs.
    const float* twiddles() const { return twiddles_.data(); }

  private:
    int n_;
    std::vector<int> radices_;
    std::vector<int> position_;
    std::vector<float> twiddles_;
};

}  // namespace domelight::simd
