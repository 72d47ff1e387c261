#include "domelight/study/sample_explanation.h"

#include "domelight/sampling/distribution/guided.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace domelight {
namespace {

/// Pieces from places[i] to places[i + 1]. The densities at their ends are given in any unit; between them they are
/// linear.
CumulativeSearch search(double xi, std::vector<double> places, const std::function<std::array<double, 2>(int)>& ends) {
    const int n = int(places.size()) - 1;
    std::vector<double> cumulative(n + 1);
    for (int i = 0; i < n; ++i) {
        const auto [a, b] = ends(i);
        cumulative[i + 1] = cumulative[i] + (a + b) / 2 * (places[i + 1] - places[i]);
    }
    const double total = cumulative[n];
    for (double& c : cumulative) c /= total;
    CumulativeSearch f;
    f.xi = xi;
    // The first piece that ends beyond ξ. If the rounding of the last sum leaves none, the last piece that is not
    // empty.
    f.index = int(std::upper_bound(cumulative.begin() + 1, cumulative.end(), xi) - cumulative.begin()) - 1;
    f.index = std::min(f.index, n - 1);
    while (f.index > 0 && cumulative[f.index + 1] == cumulative[f.index]) --f.index;
    f.begin = cumulative[f.index];
    f.end = cumulative[f.index + 1];
    f.density_begin = ends(f.index)[0] / total;
    f.density_end = ends(f.index)[1] / total;
    // Inverse of the cumulative function of a density that is linear from a to b: solves t (a + t (b − a) / 2) = s (a +
    // b) / 2.
    const double a = f.density_begin, b = f.density_end, s = std::clamp((xi - f.begin) / (f.end - f.begin), 0.0, 1.0);
    const double bottom = a + std::sqrt(std::max(0.0, a * a + s * (b * b - a * a)));
    f.fraction = a == b ? s : bottom > 0 ? s * (a + b) / bottom : 0;
    f.pdf = a + f.fraction * (b - a);
    f.position = places[f.index] + f.fraction * (places[f.index + 1] - places[f.index]);
    f.cumulative = std::move(cumulative);
    f.places = std::move(places);
    return f;
}

std::vector<double> even_places(int n, double first = 0) {
    std::vector<double> places(n + 1);
    for (int i = 0; i <= n; ++i) places[i] = (first + i) / n;
    return places;
}

/// Words for how the method finds the piece.
std::string search_words(const EnvironmentSampler& sampler, const CumulativeSearch& found, bool column, int row) {
    const int n = int(found.places.size()) - 1;
    switch (sampler.options().method) {
        case DistributionMethod::linear:
            return fmt::format("linear search: {} sums looked at", found.index + 1);
        case DistributionMethod::walk:
            return fmt::format("walking: {} values taken off xi, one by one", found.index);
        case DistributionMethod::binary:
            return fmt::format("binary search: {} halvings of {}", std::bit_width(unsigned(n)), n + 1);
        case DistributionMethod::guided: {
            const auto* guided = dynamic_cast<const GuidedDistribution*>(&sampler.distribution());
            if (!guided) return "";
            const GuidedRows& rows = column ? guided->conditional() : guided->marginal();
            const std::uint32_t xi = unit_fixed(found.xi), cell = std::uint32_t(std::uint64_t(xi) >> rows.shift);
            const int first = rows.guide_of(column ? row : 0)[cell], steps = rows.find(column ? row : 0, xi) - first;
            return fmt::format("guide table: cell {} of {} says to begin at {}; {} step{} from there", cell,
                               rows.cells(), first, steps, steps == 1 ? "" : "s");
        }
        default:
            return "";
    }
}

}  // namespace

SampleExplanation explain_sample(const EnvironmentSampler& sampler, const std::array<double, 2>& point) {
    const SamplingTextures tables = sampling_textures(sampler);
    const int w = tables.columns.width(), h = tables.columns.height();
    // The sampler takes the middle of the interval of length 2^-32 in which a point lies, so v = 0, where the Jacobian
    // vanishes, never occurs.
    const double xi_u = (unit_fixed(point[0]) + 0.5) * 0x1p-32, xi_v = (unit_fixed(point[1]) + 0.5) * 0x1p-32;
    const auto row_density = [&](int j) { return double(tables.rows.at(0, j)[1]); };
    const auto density = [&](int i, int j) { return double(tables.columns.at(i, j)[1]); };

    SampleExplanation e;
    e.point = point;
    e.continuous = sampler.distribution().continuous();
    if (e.continuous) {
        // The pieces of the rows: half a row at the top, then from row centre to row centre, and half a row at the
        // bottom. The columns go from centre to centre, around the image.
        std::vector<double> places(h + 2);
        for (int s = 1; s <= h; ++s) places[s] = (s - 0.5) / h;
        places[h + 1] = 1;
        e.row = search(xi_v, places, [&](int s) {
            return std::array{row_density(std::max(s - 1, 0)), row_density(std::min(s, h - 1))};
        });
        e.row_above = std::max(e.row.index - 1, 0);
        e.row_below = std::min(e.row.index, h - 1);
        const double t = e.row.fraction, above = (1 - t) * row_density(e.row_above),
                     below = t * row_density(e.row_below);
        e.share_below = above + below > 0 ? below / (above + below) : 0;
        const auto node = [&](int i) {
            return (1 - e.share_below) * density(i % w, e.row_above) + e.share_below * density(i % w, e.row_below);
        };
        e.column = search(xi_u, even_places(w, 0.5), [&](int i) { return std::array{node(i), node(i + 1)}; });
        if (e.column.position >= 1) e.column.position -= 1;
    } else {
        e.row = search(xi_v, even_places(h), [&](int j) { return std::array{row_density(j), row_density(j)}; });
        e.row_above = e.row_below = e.row.index;
        e.column = search(xi_u, even_places(w), [&](int i) {
            return std::array{density(i, e.row.index), density(i, e.row.index)};
        });
    }
    e.row.search = search_words(sampler, e.row, false, 0);
    e.column.search = search_words(sampler, e.column, true, e.row_above);
    e.pdf_uv = e.row.pdf * e.column.pdf;
    e.theta = k_pi * e.row.position;
    e.jacobian = 2 * k_pi * k_pi * std::sin(e.theta);
    e.sample = sampler.sample({unit_fixed(point[0]), unit_fixed(point[1])});
    return e;
}

}  // namespace domelight
