#pragma once
// Drawing points of the unit square in proportion to weights on a grid of texels: the interface that all methods share.
//
//     auto light = GuidedDistribution::build(Weights::of(weights));
//     if (!light) return light.error();
//     auto [u, v, pdf_uv] = light->sample(point);

#include "domelight/image/image.h"
#include "domelight/base/result.h"
#include "domelight/base/unit_point.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace domelight {

/// Weights of a grid of texels, by rows. Each is finite and >= 0, and already holds whatever makes equal areas of the
/// unit square differ (on a lat-long environment sin theta), for that depends on the projection.
///
/// row   row(y, room) returns the `width` weights of row y, 0 <= y < height: in `room` (width floats, for who computes
/// them) or where they are.
///       Asked once for each row, in no particular order, on as many threads as the table is built with.
struct Weights {
    int width = 0, height = 0;
    std::function<std::span<const float>(int y, std::span<float> room)> row;

    /// The weights that an image of one channel holds; the image must outlive the building.
    static Weights of(ImageView<const float> image);
};

/// A point and its density.
struct DistributionSample {
    double u = 0,
           v = 0;  ///< in [0, 1); u to the right, v down, texel (i, j) covering [i, i+1) / width x [j, j+1) / height
    double pdf_uv = 0;  ///< density over the unit square: 1 everywhere if all weights are equal
};

/// A density over the unit square that points can be drawn from. Immutable once built, so any number of threads may
/// draw.
///
/// Every method maps the unit square onto itself; `sample` pushes a point of 32-bit fixed point through that map,
/// `pdf_uv` is one over the map's Jacobian (with alias tables, which lay several pieces of the square over each texel,
/// the sum over the pieces), and `invert` goes back. All-zero weights give the uniform distribution. No call returns
/// NaN or a point outside [0, 1), and every `UnitPoint` is valid.
class Distribution2D {
  public:
    virtual ~Distribution2D() = default;

    /// The point that `point` is mapped to, and the density there, > 0.
    virtual DistributionSample sample(UnitPoint point) const = 0;

    /// Density over the unit square at (u, v), >= 0; what lies outside [0, 1) counts as the nearest point inside.
    virtual double pdf_uv(double u, double v) const = 0;

    /// The point that `sample` maps to (u, v); nothing where the density is zero there, or where the method cannot tell
    /// (alias tables cut the unit square into pieces and put them together in another order).
    virtual std::optional<UnitPoint> invert(double u, double v) const;

    /// Many points at once: u[i], v[i] in [0, 1) and pdf_uv[i] > 0 are those of sample(points[i]) rounded to float.
    /// With the piecewise-constant methods (u, v) stays in its texel: int(double(u) * width) is the drawn column. All
    /// four spans have the same length.
    ///
    /// This default calls the scalar form; methods that can do better give the same bits.
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

/// The ways to draw. Densities are proportional to the weights in each texel, but for `bilinear`.
enum class DistributionMethod {
    linear,         ///< plain: linear search of cumulative sums in double
    walk,           ///< plain: the shader's loop, which walks until the sum reaches u
    binary,         ///< binary search of float cumulative sums
    guided,         ///< guide table into fixed-point cumulative sums; constant time, monotone
    alias,          ///< alias tables; fastest on random points, tears neighbouring points apart
    hierarchical,   ///< 2 x 2 warping down a pyramid; keeps points best apart, slowest
    bilinear,       ///< continuous: bilinear between texel centres, u wraps, v clamps; guided, monotone
    bilinear_plain  ///< the same in double, by linear search
};

/// "linear", "walk", ...; as in the enumeration.
std::string method_name(DistributionMethod method);

/// Builds the tables of `method`; `threads` 0: all cores. Same bits on any number of threads.
///
/// Errors: no texels; more than 65535 columns or rows; a weight that is NaN, infinite or negative (the error names the
/// texel).
Result<std::unique_ptr<Distribution2D>> make_distribution(const Weights& weights, DistributionMethod method,
                                                          int threads = 1);

}  // namespace domelight
