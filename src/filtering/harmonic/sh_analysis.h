#pragma once

#include "domelight/image/image.h"

#include "filtering/harmonic/latitude_reduction.h"
#include "filtering/harmonic/ring_analysis.h"

#include <map>
#include <span>

namespace domelight {

/// Spherical-harmonic coefficients of a lat-long image's bilinear reconstruction. Rows are added from the top down.
/// Along a row the reconstruction's Fourier coefficients are the texels' times sinc^2(m / W), for every m (beyond W / 2
/// too: aliases that the tent does not suppress); across rows it is integrated by LatitudeReduction.
///
/// Needs memory for (band limit) x (rings) coefficients and a few rows, not for the image.
class ShAnalysis {
  public:
    ShAnalysis(int width, int height, int band_limit, int threads);

    /// The next rows (3 channels). How many at a time does not change a bit of the result.
    void add_rows(ImageView<const float> rows);
    /// Once, after the last row.
    Spectrum finish();

  private:
    void transform_finished(int next_row);

    int width_, height_, threads_;
    RingAnalysis rings_;
    LatitudeReduction reduction_;
    int next_row_ = 0;
    int next_batch_ = 0;
    /// Batches of 32 ring rows that are transformed together, to which image rows are still added; by the number of the
    /// batch.
    std::map<int, AlignedArray<float>> open_;
    std::vector<AlignedArray<float>> spare_;  ///< memory of batches that are done
};

/// A texel of a lat-long image that is black elsewhere.
struct LoneTexel {
    int x, y;
    float rgb[3];
};

/// The same for an image of a few texels, sorted by rows, in time that grows with them and not with the image.
Spectrum analyse_texels(int width, int height, std::span<const LoneTexel> texels, int band_limit, int threads);

}  // namespace domelight
