#include "domelight/filtering/resample/area_resample.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "filtering/resample/area_resample_aligned.h"
#include "filtering/resample/area_resample_latlong.h"
#include "filtering/resample/area_resample_plain.h"
#include "projection/cube_solid_angles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {

namespace {

/// The condition under which the quadrature of the fast version is exact to 1e-9.
constexpr int k_least_width = 256, k_least_height = 128;

int odd_factor(int size, int least) {
    const int factor = (least + size - 1) / size;
    return factor + (factor % 2 == 0);
}

/// Enlarges a small source without changing its reconstruction: an odd factor keeps every texel centre, and the new
/// texels between them lie on the bilinear function.
class RefinedSource : public AreaResampler {
  public:
    template <typename Make>
    RefinedSource(int width, int height, const Make& make)
        : source_(width, height, 3),
          across_(odd_factor(width, k_least_width)),
          down_(odd_factor(height, k_least_height)),
          fine_(make(width * across_, height * down_)) {}

    void add_rows(ImageView<const float> rows) override {
        assert(rows.width == source_.width() && rows.channels == 3 && filled_ + rows.height <= source_.height());
        for (int y = 0; y < rows.height; ++y)
            std::copy_n(rows.row(y), 3 * std::size_t(rows.width), source_.row(filled_++));
    }

    ImageF finish() override {
        assert(filled_ == source_.height());
        const int w = source_.width(), h = source_.height();
        ImageF row(w * across_, 1, 3);
        for (int y = 0; y < h * down_; ++y) {
            const double v = double(y - (down_ - 1) / 2) / down_;
            const int j = int(std::floor(v));
            const float *above = source_.row(std::clamp(j, 0, h - 1)),
                        *below = source_.row(std::clamp(j + 1, 0, h - 1));
            const double t = v - j;
            for (int x = 0; x < row.width(); ++x) {
                const double u = double(x - (across_ - 1) / 2) / across_;
                const int i = int(std::floor(u)), left = 3 * ((i + w) % w), right = 3 * ((i + 1) % w);
                const double s = u - i;
                for (int c = 0; c < 3; ++c)
                    row.at(x, 0)[c] = float((above[left + c] * (1 - s) + above[right + c] * s) * (1 - t) +
                                            (below[left + c] * (1 - s) + below[right + c] * s) * t);
            }
            fine_->add_rows(row);
        }
        return fine_->finish();
    }

  private:
    ImageF source_;
    int across_, down_, filled_ = 0;
    std::unique_ptr<AreaResampler> fine_;
};

/// Averages blocks of a larger cube's texels, each by its own solid angle: exactly the texels of a smaller one. So no
/// texel of the fast version spans many source rows.
class CoarsenedCube : public AreaResampler {
  public:
    CoarsenedCube(int size, int factor, int threads, std::unique_ptr<AreaResampler> fine)
        : size_(size), factor_(factor), threads_(threads), fine_(std::move(fine)) {}

    void add_rows(ImageView<const float> rows) override { fine_->add_rows(rows); }

    ImageF finish() override {
        const ImageF fine = fine_->finish();
        const std::vector<double> angles = cube_solid_angles(fine.width(), threads_);
        ImageF out(size_, 6 * size_, 3);
        parallel_for(6 * size_, threads_, [&](int row) {
            for (int x = 0; x < size_; ++x) average(fine, angles, x, row, out.at(x, row));
        });
        return out;
    }

  private:
    void average(const ImageF& fine, const std::vector<double>& angles, int out_x, int out_row, float* to) const {
        const int n = fine.width(), top = out_row / size_ * n;
        double sum[3] = {}, total = 0;
        for (int y = out_row % size_ * factor_; y < (out_row % size_ + 1) * factor_; ++y) {
            const double* row_angles = &angles[std::size_t(y) * n];
            const float* from = fine.row(top + y);
            for (int x = out_x * factor_; x < (out_x + 1) * factor_; ++x) {
                const double w = row_angles[x];
                for (int c = 0; c < 3; ++c) sum[c] += w * from[3 * x + c];
                total += w;
            }
        }
        for (int c = 0; c < 3; ++c) to[c] = float(sum[c] / total);
    }

    int size_, factor_, threads_;
    std::unique_ptr<AreaResampler> fine_;
};

}  // namespace

std::unique_ptr<AreaResampler> area_resample_to_cube(int width, int height, int size, const Mat3& world_to_source,
                                                     int threads) {
    assert(width >= 1 && height >= 1 && size >= 1);
    const auto aligned = area::align(world_to_source);
    if (!aligned) return area::plain_to_cube(width, height, size, world_to_source, threads);
    if (width < k_least_width || height < k_least_height)
        return std::make_unique<RefinedSource>(
            width, height, [&](int w, int h) { return area_resample_to_cube(w, h, size, world_to_source, threads); });
    const int least = std::max(width / 16, height / 8), factor = (least + size - 1) / size;
    auto resampler = area::aligned_to_cube(width, height, size * factor, *aligned, threads);
    if (factor == 1) return resampler;
    return std::make_unique<CoarsenedCube>(size, factor, threads, std::move(resampler));
}

std::unique_ptr<AreaResampler> area_resample_to_latlong(int width, int height, int out_height,
                                                        const Mat3& world_to_source, int threads) {
    assert(width >= 1 && height >= 1 && out_height >= 1);
    if (const auto aligned = area::align(world_to_source); aligned && area::keeps_polar_axis(*aligned))
        return area::aligned_to_latlong(width, height, out_height, *aligned, threads);
    return area::plain_to_latlong(width, height, out_height, world_to_source, threads);
}

}  // namespace domelight
