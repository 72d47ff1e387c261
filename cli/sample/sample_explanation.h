#pragma once

#include "domelight/sampling/environment_sampler.h"

#include <array>
#include <string>
#include <vector>

namespace domelight::cli {

/// One search in a cumulative function: which of its pieces xi falls into, and where in it.
struct Found {
    double xi = 0;
    int index = 0;                              ///< of the piece
    double begin = 0;                           ///< cumulative function where the piece begins,
    double end = 0;                             ///< and where it ends: begin <= xi < end
    double fraction = 0;                        ///< position in the piece, [0, 1)
    double position = 0;                        ///< v or u
    double pdf = 0;                             ///< density of that, per unit of v or u
    double density_begin = 0, density_end = 0;  ///< at the piece's ends; equal where it is constant
    std::vector<double> cumulative;             ///< [pieces + 1]
    std::vector<double> places;                 ///< v or u where each piece begins, [pieces + 1]
    std::string search;                         ///< how the method finds it, in words; may be empty
};

/// How a point of the unit square becomes a direction, with every number in between.
struct Explanation {
    std::array<double, 2> point{};  ///< (xi for u, xi for v)
    bool continuous = false;
    Found row, column;
    int row_above = 0, row_below = 0;  ///< the rows whose mixture the column comes from; the same one unless continuous
    double share_below = 0;            ///< of row_below in that mixture
    double pdf_uv = 0, theta = 0, jacobian = 0;
    LightSample sample;  ///< what the sampler itself gives
};

/// Follows `point` through the marginal and the conditional in double, as docs/math/sampling.md has it. Not for alias
/// and hierarchical, which have neither.
Explanation explain(const EnvironmentSampler& sampler, const std::array<double, 2>& point);

}  // namespace domelight::cli
