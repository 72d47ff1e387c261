#pragma once
// Sampling of a piecewise-constant density in its simplest form, in double. The fast methods are tested against it.

#include "domelight/sampling/distribution/distribution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// A piecewise-constant density over [0, 1): p(x) = f_i / mean(f) on [i, i+1) / n.
///
/// Inverse transform sampling (Pharr, Jakob, Humphreys, Physically Based Rendering, 4th ed., 2.3 and A.4.6): the
/// cumulative function is P(x_i) = sum_{k<i} f_k / sum f, linear in between; x with P(x) = xi has density p.
class PlainDistribution1D {
  public:
    /// values   n >= 1 values, finite, >= 0; all zero: the uniform density
    explicit PlainDistribution1D(std::span<const double> values);

    struct Sample {
        double x;    ///< in [0, 1)
        double pdf;  ///< density per unit of x
        int index;   ///< of the value drawn, whose density is never zero
    };
    /// Searches for the interval with P(x_i) <= xi < P(x_{i+1}) from the left. xi in [0, 1).
    Sample sample_linear(double xi) const;
    /// The loop of a fragment shader: subtracts the values one after the other from xi * sum(f), until a value is
    /// larger than what remains. The remainder over that value is the position in the interval. No cumulative table is
    /// needed.
    Sample sample_walk(double xi) const;
    double pdf(double x) const;
    /// P(x), the xi that gives x.
    double invert(double x) const;

    int size() const { return int(values_.size()); }
    double mean() const { return sum_ / size(); }  ///< of the values given
    double value(int i) const { return values_[i]; }
    std::size_t memory_bytes() const { return (values_.size() + cumulative_.size()) * sizeof(double); }

  private:
    std::vector<double> values_, cumulative_;  // cumulative_[i] = sum of the values before i, [n + 1]
    double sum_;                               // of the values given
};

/// Marginal and conditional sampling (ibid., A.5.1): the row by the rows' averages, then the column by the row's
/// values; p(u, v) = p(v) p(u | v) = (row average / total average) (f / row average) = f / total average.
class PlainDistribution2D final : public Distribution2D {
  public:
    enum class Search { linear, walk };
    /// Errors: as make_distribution.
    static Result<PlainDistribution2D> build(const Weights& weights, Search search = Search::linear);

    DistributionSample sample(UnitPoint point) const override;
    using Distribution2D::sample;
    double pdf_uv(double u, double v) const override;
    std::optional<UnitPoint> invert(double u, double v) const override;
    int width() const override { return rows_.front().size(); }
    int height() const override { return int(rows_.size()); }
    std::size_t memory_bytes() const override;

  private:
    PlainDistribution2D(std::vector<PlainDistribution1D> rows, PlainDistribution1D averages, Search search)
        : rows_(std::move(rows)), averages_(std::move(averages)), search_(search) {}
    std::vector<PlainDistribution1D> rows_;
    PlainDistribution1D averages_;
    Search search_;
};

}  // namespace domelight
