#pragma once
// How the environment sampler turns a point of the unit square into a direction, with every number on the way.

#include "domelight/sampling/environment_sampler.h"

#include <array>
#include <string>
#include <vector>

namespace domelight {

/// One search in a cumulative function: the piece that xi falls into, and where in that piece.
struct CumulativeSearch {
    double xi = 0;
    int index = 0;                              ///< index of the piece
    double begin = 0;                           ///< cumulative function where the piece begins
    double end = 0;                             ///< cumulative function where the piece ends: begin <= xi < end
    double fraction = 0;                        ///< position in the piece, [0, 1)
    double position = 0;                        ///< the v or u that was found
    double pdf = 0;                             ///< density of position, per unit of v or u
    double density_begin = 0, density_end = 0;  ///< density at the ends of the piece; equal where it is constant
    std::vector<double> cumulative;             ///< [pieces + 1]
    std::vector<double> places;                 ///< v or u where each piece begins, [pieces + 1]
    std::string search;                         ///< how the method finds the piece, in words; may be empty
};

struct SampleExplanation {
    std::array<double, 2> point{};  ///< (xi for u, xi for v)
    bool continuous = false;        ///< as Distribution2D::continuous()
    CumulativeSearch row, column;
    int row_above = 0, row_below = 0;  ///< the column is drawn from a mixture of these; one row unless continuous
    double share_below = 0;            ///< weight of row_below in the mixture, [0, 1]
    double pdf_uv = 0, theta = 0, jacobian = 0;
    LightSample sample;  ///< what the sampler gives for the point
};

/// Follows a point through the marginal and the conditional distribution in double precision (docs/math/sampling.md).
///
/// sampler  of any method but alias and hierarchical, which have no marginal
/// point    (xi for u, xi for v), each in [0, 1)
SampleExplanation explain_sample(const EnvironmentSampler& sampler, const std::array<double, 2>& point);

}  // namespace domelight
