#pragma once

#include "domelight/image/image.h"
#include "domelight/base/vec.h"

#include "filtering/harmonic/row_kernels.h"
#include "filtering/harmonic/zonal_sum.h"

#include <span>
#include <utility>
#include <vector>

namespace domelight {

/// Point lights that stand for an environment's few brightest texels, in the source's frame.
struct BrightPoints {
    std::vector<float> x, y, z, r, g, b;
    int count() const { return int(x.size()); }
    /// A light of radiance `rgb` over `solid_angle` in a unit direction.
    void add(const Vec3d& direction, double solid_angle, const float* rgb) {
        x.push_back(float(direction.x)), y.push_back(float(direction.y)), z.push_back(float(direction.z));
        r.push_back(float(solid_angle * rgb[0])), g.push_back(float(solid_angle * rgb[1])),
            b.push_back(float(solid_angle * rgb[2]));
    }
    /// Those of `p` from `from` up to `to`.
    void append(const BrightPoints& p, int from, int to) {
        for (auto [mine, theirs] : {std::pair{&x, &p.x}, {&y, &p.y}, {&z, &p.z}, {&r, &p.r}, {&g, &p.g}, {&b, &p.b}})
            mine->insert(mine->end(), theirs->begin() + from, theirs->begin() + to);
    }
    Vec3d place(int i) const { return {x[i], y[i], z[i]}; }
    simd::PointSet view() const { return {x.data(), y.data(), z.data(), r.data(), g.data(), b.data(), count()}; }
};

/// A texel with less than this part of all power leaves nothing that can be seen.
constexpr double k_least_share = 1e-4;
/// And one that is not this many times the mean is no sun: among others like it, what truncation leaves out cancels.
/// (In small images every texel has its share.)
constexpr double k_least_contrast = 10;

/// Points that stand for all suns together, at most. A sun is a few texels, of 4 to 1024 points each; where more than
/// these are so bright it is a glow, the strongest of it are taken, and the rest, among others like it, cancels. (Each
/// costs a kernel's evaluation at every texel of a level: a smooth sky of 512 x 256 once took minutes.)
constexpr int k_most_points = 2048;

/// Finds the texels that carry the most power (radiance times solid angle) as the rows of a lat-long image pass by.
///
/// A sun is the worst case of a truncated spectrum: its coefficients do not fall off. What the truncation leaves out of
/// a kernel, summed over these texels exactly, is what the expansion is still short of (ResidualKernel).
class BrightTexels {
  public:
    BrightTexels(int width, int height, int most = 1024);

    /// The next rows, with simd::summarize of each.
    void add_rows(ImageView<const float> rows, std::span<const simd::Summary> summaries);
    /// The texels with more than k_least_share of the power of all, each as the nodes of a Gauss-Legendre rule over its
    /// tent, fine enough for degrees around `band_limit`. `mean`: mean radiance.
    BrightPoints points(const Vec3d& mean, int band_limit) const;

  private:
    struct Texel {
        double power;  ///< of the strongest channel
        int x, y;
        float rgb[3];
    };
    /// Order of the heap: weakest first; ties by place, so that the result does not depend on how rows were handed
    /// over.
    static bool stronger(const Texel& a, const Texel& b) {
        return a.power != b.power ? a.power > b.power : a.y != b.y ? a.y < b.y : a.x < b.x;
    }

    int width_, height_, most_, next_row_ = 0;
    double sum_ = 0;  ///< power so far, of the channels' mean
    std::vector<Texel> heap_;
};

}  // namespace domelight
