#include "filtering/read_texels.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include "projection/bordered_cube.h"
#include "projection/cube_solid_angles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

/// Levels of at most this size are solved for: the kink that wide lobes have at the horizon lies between their texels.
constexpr int k_most_solved = 32;
/// Samples along a texel's side: two are as good as four where texels are small against the kink.
constexpr int k_most_factor = 4, k_least_factor = 2;
/// Steps of conjugate gradients. The error shrinks to a third or less with each, and begins at a hundredth of the light.
constexpr int k_steps = 6;

/// RGB values, of texels or of samples: (face · width + y) · width + x.
using Values = std::vector<Vec3d>;

/// The lookups of a cube at the centres of a cube that is `factor` times as fine, as a linear map of its texels.
class Lookups {
  public:
    Lookups(int size, int factor) : size_(size), factor_(factor), stride_(size + 2) {
        for (int i = 0; i < size * factor; ++i) {
            const double at = (i + 0.5) / factor - 0.5;
            const int below = int(std::floor(at));
            places_.push_back({below + 1, at - below});
        }
    }

    /// R x: the samples of these texels.
    Values samples(const Values& texels) const {
        const Values bordered = with_borders(texels);
        Values out(6 * places_.size() * places_.size());
        for_each_sample([&](std::size_t sample, std::size_t corner, const double(&w)[4]) {
            out[sample] = bordered[corner] * w[0] + bordered[corner + 1] * w[1] + bordered[corner + stride_] * w[2] +
                          bordered[corner + stride_ + 1] * w[3];
        });
        return out;
    }

    /// Rᵀ s: each sample's value added to the texels that it reads, times their weights.
    Values to_texels(const Values& samples) const {
        Values bordered(6 * stride_ * stride_);
        for_each_sample([&](std::size_t sample, std::size_t corner, const double(&w)[4]) {
            bordered[corner] += samples[sample] * w[0];
            bordered[corner + 1] += samples[sample] * w[1];
            bordered[corner + stride_] += samples[sample] * w[2];
            bordered[corner + stride_ + 1] += samples[sample] * w[3];
        });
        return without_borders(bordered);
    }

  private:
    struct Place {
        int below;        ///< column or row of the bordered face: 0 is outside
        double fraction;  ///< towards the next
    };

    template <typename Use>
    void for_each_sample(const Use& use) const {
        std::size_t sample = 0;
        for (std::size_t face = 0; face < 6; ++face)
            for (const Place& y : places_)
                for (const Place& x : places_) {
                    const double s = x.fraction, t = y.fraction;
                    const double weights[4] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
                    use(sample++, (face * stride_ + std::size_t(y.below)) * stride_ + std::size_t(x.below), weights);
                }
    }

    /// Calls use(bordered index, texel index, weight) for each texel that a bordered one is made of.
    template <typename Use>
    void for_each_border(const Use& use) const {
        const int n = size_;
        const auto outside = [n](int i) { return i < 0 || i == n; };
        for (int face = 0; face < 6; ++face)
            for (int y = -1; y <= n; ++y)
                for (int x = -1; x <= n; ++x) {
                    const std::size_t at =
                        (std::size_t(face) * stride_ + std::size_t(y + 1)) * stride_ + std::size_t(x + 1);
                    if (!outside(x) || !outside(y)) {
                        use(at, std::size_t(texel_or_across(n, face, x, y)), 1.0);
                        continue;
                    }
                    const int inner_x = std::clamp(x, 0, n - 1), inner_y = std::clamp(y, 0, n - 1);
                    for (const auto& [i, j] : {std::pair{inner_x, inner_y}, {x, inner_y}, {inner_x, y}})
                        use(at, std::size_t(texel_or_across(n, face, i, j)), 1.0 / 3);
                }
    }

    Values with_borders(const Values& texels) const {
        Values bordered(6 * stride_ * stride_);
        for_each_border(
            [&](std::size_t at, std::size_t texel, double weight) { bordered[at] += texels[texel] * weight; });
        return bordered;
    }
    Values without_borders(const Values& bordered) const {
        Values texels(std::size_t(6) * size_ * size_);
        for_each_border(
            [&](std::size_t at, std::size_t texel, double weight) { texels[texel] += bordered[at] * weight; });
        return texels;
    }

    int size_, factor_;
    std::size_t stride_;         ///< of a bordered face
    std::vector<Place> places_;  ///< of the samples along a side of a face
};

Vec3d times(const Vec3d& a, const Vec3d& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
/// 0 where the divisor is 0.
Vec3d over(const Vec3d& a, const Vec3d& b) {
    const auto quotient = [](double p, double q) { return q != 0 ? p / q : 0; };
    return {quotient(a.x, b.x), quotient(a.y, b.y), quotient(a.z, b.z)};
}

/// ∑ a b, each channel by itself.
Vec3d channel_products(const Values& a, const Values& b) {
    Vec3d sum;
    for (std::size_t i = 0; i < a.size(); ++i) sum += times(a[i], b[i]);
    return sum;
}

/// The least-squares problem: texels x that make ∑ ω |R x − f|² least, over the samples f with solid angles ω.
class ReadFit {
  public:
    ReadFit(const Cubemap& fine, int size)
        : lookups_(size, fine.size() / size), angles_(cube_solid_angles(fine.size(), 1)) {
        for (int y = 0; y < fine.strip().height; ++y)
            for (int x = 0; x < fine.size(); ++x) {
                const float* p = fine.strip().at(x, y);
                light_.push_back({p[0], p[1], p[2]});
            }
        const Values ones(light_.size(), Vec3d{1, 1, 1});
        diagonal_ = lookups_.to_texels(weighted(ones));
    }

    /// Conjugate gradients with the sum of each row of RᵀωR as preconditioner, from the means of the samples that each
    /// texel reads. A fixed number of steps in a fixed order: the same bytes on any machine.
    Values solve() const {
        Values x = lookups_.to_texels(weighted(light_));
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = over(x[i], diagonal_[i]);
        Values residual = lookups_.to_texels(weighted(light_));
        subtract(residual, product(x), {1, 1, 1});
        Values step = preconditioned(residual);
        Vec3d size = channel_products(residual, step);
        for (int i = 0; i < k_steps; ++i) {
            const Values image = product(step);
            const Vec3d length = over(size, channel_products(step, image));
            subtract(x, step, -length);
            subtract(residual, image, length);
            const Values next = preconditioned(residual);
            const Vec3d next_size = channel_products(residual, next), turn = over(next_size, size);
            for (std::size_t k = 0; k < step.size(); ++k) step[k] = next[k] + times(step[k], turn);
            size = next_size;
        }
        return x;
    }

  private:
    Values weighted(Values samples) const {
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] *= angles_[i % angles_.size()];
        return samples;
    }
    Values product(const Values& texels) const { return lookups_.to_texels(weighted(lookups_.samples(texels))); }
    Values preconditioned(const Values& residual) const {
        Values out(residual.size());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = over(residual[i], diagonal_[i]);
        return out;
    }
    static void subtract(Values& from, const Values& values, const Vec3d& factor) {
        for (std::size_t i = 0; i < from.size(); ++i) from[i] -= times(values[i], factor);
    }

    Lookups lookups_;
    std::vector<double> angles_;  ///< of a face's samples
    Values light_, diagonal_;
};

/// The texels less a twelfth of their second differences. Between two texels a lookup lies above a curve by h² f''/12
/// on average, and this takes it away: what least squares comes to where the light is smooth from texel to texel.
Cubemap less_curvature(const Cubemap& centres, int threads) {
    const BorderedCube bordered(centres);
    const int n = centres.size();
    Cubemap out(ImageF::uninitialized(n, 6 * n, 3));
    parallel_ranges(6 * n, 16, threads, [&](int begin, int end) {
        for (int row = begin; row < end; ++row) {
            const int face = row / n, y = row % n;
            float* to = out.face(face).row(y);
            for (int x = 0; x < n; ++x) {
                const float *at = bordered.texel(face, x, y), *above = bordered.texel(face, x, y - 1),
                            *below = bordered.texel(face, x, y + 1);
                for (int c = 0; c < 3; ++c) {
                    const float curvature =
                        (at[c - 3] - at[c]) + (at[c + 3] - at[c]) + (above[c] - at[c]) + (below[c] - at[c]);
                    to[3 * x + c] = std::max(0.f, at[c] - curvature * (1.f / 12));
                }
            }
        }
    });
    return out;
}

}  // namespace

bool gains_by_read_texels(const ZonalKernel& kernel, int size) {
    return kernel.angular_width() * size >= k_pi / 4;
}

int read_texels_factor(int size) {
    if (size > k_most_solved) return 1;
    return std::clamp(k_least_factor * k_most_solved / size, k_least_factor, k_most_factor);
}

Cubemap read_texels(const Cubemap& fine, int size, int threads) {
    if (fine.size() == size) return less_curvature(fine, threads);
    const Values texels = ReadFit(fine, size).solve();
    Cubemap cube(ImageF::uninitialized(size, 6 * size, 3));
    float* out = cube.pixels().data();
    for (const Vec3d& texel : texels)
        for (const double value : {texel.x, texel.y, texel.z}) *out++ = float(std::max(0.0, value));
    return cube;
}

}  // namespace domelight
