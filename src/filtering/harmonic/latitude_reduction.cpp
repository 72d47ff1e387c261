#include "filtering/harmonic/latitude_reduction.h"

#include "domelight/base/vec.h"

#include "base/gauss_legendre.h"
#include "base/interpolation_taps.h"
#include "base/sort.h"

#include <algorithm>
#include <cmath>

namespace domelight {

LatitudeReduction::LatitudeReduction(int image_height, int rings, double band, double decay)
    : rows_(rings + 2 * k_pad) {
    const InterpolationTaps taps(2 * k_pad, band, decay);
    // Between two knots (image row centres, ring latitudes) both tent and taps are polynomials; sin theta is smooth.
    std::vector<double> knots{0, k_pi};
    for (int j = 0; j < image_height; ++j) knots.push_back(k_pi * (j + 0.5) / image_height);
    for (int k = 0; k < rings; ++k) knots.push_back(k_pi * (k + 0.5) / rings);
    sort_items(knots);

    std::vector<std::vector<double>> weights(rows_.size());
    const auto add = [&](int k, int j, double w) {
        Row& row = rows_[k];
        if (weights[k].empty()) row.first = j;
        // Knots ascend, so the rows of the image come in order.
        weights[k].resize(std::max<std::size_t>(weights[k].size(), j - row.first + 1));
        weights[k][j - row.first] += w;
    };
    const auto& rule = gauss_legendre(8);
    std::vector<double> tap(taps.taps());
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double middle = 0.5 * (knots[i] + knots[i + 1]), half = 0.5 * (knots[i + 1] - knots[i]);
        if (half < 1e-15) continue;
        const int ring = int(std::floor(middle / k_pi * rings - 0.5));
        const int below = int(std::floor(middle / k_pi * image_height - 0.5));
        for (std::size_t q = 0; q < rule.x.size(); ++q) {
            const double theta = middle + half * rule.x[q];
            const double weight = half * rule.w[q] * std::sin(theta);
            taps.weights(theta / k_pi * rings - 0.5 - ring, tap);
            const double t = theta / k_pi * image_height - 0.5 - below;
            const int j0 = std::max(below, 0), j1 = std::min(below + 1, image_height - 1);
            for (int k = 0; k < taps.taps(); ++k) {
                const int row = ring + k - (k_pad - 1) + k_pad;
                add(row, j0, weight * tap[k] * (j0 == j1 ? 1 : 1 - t));
                if (j0 != j1) add(row, j1, weight * tap[k] * t);
            }
        }
    }
    for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k].weights.assign(weights[k].begin(), weights[k].end());
}

}  // namespace domelight
