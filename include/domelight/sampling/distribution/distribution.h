#pragma once
// Drawing points of the unit square in proportion to weights on a grid of texels: the interface that all methods share.
//
//     auto light = GuidedDistribution::build(Weights::of(weights));
//     if (!light) return light.error();
//     auto [u, v, pdf_uv] = light->sample(point);

#include "domelight/base/names.h"
#include "domelight/base/result.h"
#include "domelight/base/unit_point.h"
#include "domelight/image/image.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace domelight {

/// Weights of a grid of texels, by rows. Each is finite and >= 0, and already includes the factor by which equal areas
/// of the unit square differ (sin theta for a lat-long environment), because that depends on the projection.
///
// clang-format off
/// row   row(y, room) returns the `width` weights of row y, 0 <= y < height. They may be computed into `room` (width
///       floats) or lie anywhere else. Called once for each row, in no particular order, on as many threads as build
///       the table.
// clang-format on
struct Weights {
    int width = 0, height = 0;
    std::function<std::span<const float>(int y, std::span<float> room)> row;

    /// The weights in an image of one channel. The image must exist until the tables are built.
    static Weights of(ImageView<const float> image);
};

/// A point and its density.
struct DistributionSample {
    /// In [0, 1): u to the right, v down. Texel (i, j) covers [i, i+1) / width x [j, j+1) / height.
    double u = 0, v = 0;
    double pdf_uv = 0;  ///< density over the unit square: 1 everywhere if all weights are equal
};

/// A density over the unit square that can be sampled. Immutable once built, so any number of threads may draw.
///
/// Every method maps the unit square onto itself. `sample` applies this map to a point in 32-bit fixed point, `pdf_uv`
/// is one over the map's Jacobian (with alias tables, which map several pieces of the square to each texel, the sum
/// over the pieces), and `invert` is the inverse map. All-zero weights give the uniform distribution. No call returns
/// NaN or a point outside [0, 1), and every `UnitPoint` is valid.
class Distribution2D {
  public:
    virtual ~Distribution2D() = default;

    /// The point that `point` is mapped to, and the density there, > 0.
    virtual DistributionSample sample(UnitPoint point) const = 0;

    /// Density over the unit square at (u, v), >= 0. A point outside [0, 1) counts as the nearest point inside.
    virtual double pdf_uv(double u, double v) const = 0;

    /// The point that `sample` maps to (u, v). Empty if the density there is zero, or if the method has no inverse
    /// (alias tables cut the unit square into pieces and reorder them).
    virtual std::optional<UnitPoint> invert(double u, double v) const;

    /// Many points at once: u[i], v[i] in [0, 1) and pdf_uv[i] > 0 are those of sample(points[i]) rounded to float.
    /// With the piecewise-constant methods (u, v) stays in its texel: int(double(u) * width) is the drawn column. All
    /// four spans have the same length.
    ///
    /// By default this calls the scalar form. Faster overrides give the same bits.
    virtual void sample(std::span<const UnitPoint> points, std::span<float> u, std::span<float> v,
                        std::span<float> pdf_uv) const;

    /// Densities at many points at once, those of pdf_uv(u[i], v[i]) rounded to float. All spans have the same length.
    virtual void pdfs_uv(std::span<const float> u, std::span<const float> v, std::span<float> pdf_uv) const;

    virtual int width() const = 0;
    virtual int height() const = 0;
    /// Whether the density is continuous (bilinear between texel centres) or constant in each texel.
    virtual bool continuous() const { return false; }
    /// Bytes of the tables.
    virtual std::size_t memory_bytes() const = 0;
};

/// Sampling methods. The density is constant in each texel and proportional to its weight, except with `bilinear` and
/// `bilinear_plain`.
enum class DistributionMethod {
    linear,         ///< plain: linear search of cumulative sums in double
    walk,           ///< plain: the loop of a shader, which subtracts weights from xi times their sum until one is
                    ///< larger than the rest
    binary,         ///< binary search of float cumulative sums
    guided,         ///< guide tables into fixed-point cumulative sums; constant time, monotone
    alias,          ///< alias tables; fastest on random points, but separates neighbouring points
    hierarchical,   ///< 2 x 2 warping down a pyramid; keeps points best distributed, slowest
    bilinear,       ///< continuous: bilinear between texel centres, u wraps, v clamps; guided, monotone
    bilinear_plain  ///< the same in double, by linear search
};
template <>
struct EnumNames<DistributionMethod> {
    static constexpr const char* kind = "a method of sampling";
    static constexpr NamedValue<DistributionMethod> table[] = {
        {DistributionMethod::linear, "linear"},     {DistributionMethod::walk, "walk"},
        {DistributionMethod::binary, "binary"},     {DistributionMethod::guided, "guided"},
        {DistributionMethod::alias, "alias"},       {DistributionMethod::hierarchical, "hierarchical"},
        {DistributionMethod::bilinear, "bilinear"}, {DistributionMethod::bilinear_plain, "bilinear-plain"},
    };
};

/// Builds the tables of `method`; `threads` 0: all cores. The bits are the same on any number of threads.
///
/// Errors: no texels; more than 65535 columns or rows; a weight that is NaN, infinite or negative (the error names the
/// texel).
Result<std::unique_ptr<Distribution2D>> make_distribution(const Weights& weights, DistributionMethod method,
                                                          int threads = 1);

}  // namespace domelight
