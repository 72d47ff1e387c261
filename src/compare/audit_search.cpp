#include "compare/audit_search.h"

#include "domelight/base/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

/// Distance of neighbours, as a share of the roughness. Over this distance the squared error is close to a parabola,
/// and filtered light can be interpolated to 1e-4.
constexpr double k_spacing = 0.04;
/// Filtering with a narrower lobe takes as long as a whole bake, so it is done only at a stated roughness.
constexpr double k_least_searched = 0.08;
/// An error that the rounding of half floats explains.
constexpr double k_exact_fit = 0.001;
/// Roughnesses at which interpolated light is fitted between two neighbours of the best fit.
constexpr int k_coarse_steps = 16;

double square(double x) {
    return x * x;
}

/// The scale in which filtered light is interpolated over three roughnesses, of which the first may be 0: near a lamp
/// it is about a power of the roughness, and at 0 it changes with the lobe's width, the square of the roughness.
double interpolation_scale(double roughness, bool from_mirror) {
    return from_mirror ? square(roughness) : std::log(roughness);
}

/// Lagrange's weights at x of three points.
std::array<double, 3> weights_at(double x, const std::array<double, 3>& p) {
    return {(x - p[1]) * (x - p[2]) / ((p[0] - p[1]) * (p[0] - p[2])),
            (x - p[0]) * (x - p[2]) / ((p[1] - p[0]) * (p[1] - p[2])),
            (x - p[0]) * (x - p[1]) / ((p[2] - p[0]) * (p[2] - p[1]))};
}

/// Interpolates the logarithm where possible.
float interpolate(const std::array<float, 3>& v, const std::array<double, 3>& w) {
    if (v[0] > 0 && v[1] > 0 && v[2] > 0)
        return float(std::exp(w[0] * std::log(v[0]) + w[1] * std::log(v[1]) + w[2] * std::log(v[2])));
    return float(std::max(0.0, w[0] * v[0] + w[1] * v[1] + w[2] * v[2]));
}

/// Where the parabola through three points (x rising) is lowest, clamped to the outer points.
double parabola_minimum(const std::array<double, 3>& x, const std::array<double, 3>& y) {
    const double ab = x[1] - x[0], cb = x[1] - x[2];
    const double p = ab * (y[1] - y[2]), q = cb * (y[1] - y[0]);
    return p == q ? x[1] : std::clamp(x[1] - 0.5 * (ab * p - cb * q) / (p - q), x[0], x[2]);
}

}  // namespace

double least_roughness(int size) {
    return std::sqrt(k_pi / (4 * size));
}

RoughnessRange roughness_range(bool mirror, int size, std::optional<double> stated) {
    RoughnessRange range{mirror, std::min(0.9, std::max(least_roughness(size), k_least_searched))};
    if (!mirror) range.least = 0.1;
    if (stated && *stated > 0) range.least = std::min(range.least, *stated * (1 - k_spacing));
    return range;
}

LevelSearch::LevelSearch(TexelSample sample, std::vector<int> turned, RoughnessRange range)
    : sample_(std::move(sample)), turned_(std::move(turned)), range_(range) {}

void LevelSearch::add(double roughness, const Cubemap& exact) {
    if (has(roughness)) return;
    Tried tried{roughness, {}, mean_luminance(exact), values_at(exact, turned_)};
    tried.fit = fit_level(sample_, tried.exact);
    const auto above = [](double r, const Tried& t) { return r < t.roughness; };
    tried_.insert(std::upper_bound(tried_.begin(), tried_.end(), roughness, above), std::move(tried));
}

bool LevelSearch::has(double roughness) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const Tried& t) { return t.roughness == roughness; });
}

Fit LevelSearch::trusting(double roughness) const {
    const auto above = [](double r, const Tried& t) { return r < t.roughness; };
    const std::size_t after =
        std::size_t(std::upper_bound(tried_.begin(), tried_.end(), roughness, above) - tried_.begin());
    if (after > 0 && tried_[after - 1].roughness == roughness) return fit_level(sample_, tried_[after - 1].exact, 1);
    if (tried_.size() < 3) return {};
    return fit_level(sample_, interpolated(roughness, std::clamp<std::size_t>(after, 1, tried_.size() - 2)).exact, 1);
}

double LevelSearch::error_at(double roughness) const {
    for (const Tried& t : tried_)
        if (t.roughness == roughness) return t.fit.error;
    return 1;
}

std::size_t LevelSearch::best() const {
    const auto less = [](const Tried& a, const Tried& b) { return a.fit.error < b.fit.error; };
    return std::size_t(std::min_element(tried_.begin(), tried_.end(), less) - tried_.begin());
}

double LevelSearch::allowed(double roughness) const {
    return range_.mirror && roughness < 0.5 * range_.least ? 0 : std::clamp(roughness, range_.least, 1.0);
}

/// This roughness and a neighbour on either side.
std::vector<double> LevelSearch::near(double roughness) const {
    if (roughness == 0) return {0};
    std::vector<double> values;
    for (const double r : {roughness * (1 - k_spacing), roughness, roughness * (1 + k_spacing)})
        if (const double inside = std::clamp(r, range_.least, 1.0);
            !has(inside) && (values.empty() || inside != values.back()))
            values.push_back(inside);
    return values;
}

/// Whether a smaller roughness than the best fit's was tried, or none is allowed. 0 does not count as a neighbour: the
/// error is not a parabola over so large a distance.
bool LevelSearch::neighbour_below() const {
    const std::size_t b = best();
    const double at = tried_[b].roughness;
    return (b > 0 && tried_[b - 1].roughness > 0) || at <= range_.least;
}

bool LevelSearch::neighbour_above() const {
    return best() + 1 < tried_.size() || tried_[best()].roughness >= 1;
}

double LevelSearch::minimum() const {
    const std::size_t b = best();
    if (b == 0 || b + 1 == tried_.size()) return tried_[b].roughness;
    std::array<double, 3> x, y;
    for (std::size_t i = 0; i < 3; ++i) x[i] = tried_[b - 1 + i].roughness, y[i] = square(tried_[b - 1 + i].fit.error);
    return parabola_minimum(x, y);
}

std::vector<double> LevelSearch::wanted() const {
    if (guess_ && !has(*guess_)) {
        std::vector<double> values = near(*guess_);
        if (try_mirror_ && *guess_ > 0) values.push_back(0);
        return values;
    }
    if (tried_.empty()) return {};
    const std::size_t b = best();
    const double at = tried_[b].roughness;
    if (at == 0) return {};
    std::vector<double> values;
    const bool below = neighbour_below(), above = neighbour_above();
    if (!below || !above) {
        // One spacing beyond the guess's neighbours; farther with each roughness tried since.
        const double step = k_spacing * at * double(std::max<std::size_t>(3, tried_.size()) - 2);
        const double lower = std::max(range_.least, at - step), upper = std::min(1.0, at + step);
        // A guess that is exact needs a neighbour only to measure how fast the error grows. The wider lobe is faster.
        if (at == guess_ && tried_[b].fit.error <= k_exact_fit) {
            if (tried_.size() > 1) return {};
            return {above ? lower : upper};
        }
        if (!below) values.push_back(lower);
        if (!above) values.push_back(upper);
        return values;
    }
    const double low = b > 0 ? tried_[b - 1].roughness : at,
                 high = b + 1 < tried_.size() ? tried_[b + 1].roughness : at;
    if (high - low <= 2.5 * k_spacing * at) return {};
    return near(std::max(range_.least, minimum()));
}

/// The fit at any roughness, with the exact light interpolated over three neighbours, of which tried_[middle] is the
/// second.
LevelSearch::Tried LevelSearch::interpolated(double roughness, std::size_t middle) const {
    const Tried &a = tried_[middle - 1], &b = tried_[middle], &c = tried_[middle + 1];
    const auto scale = [&](double r) { return interpolation_scale(r, a.roughness == 0); };
    const auto w = weights_at(scale(roughness), {scale(a.roughness), scale(b.roughness), scale(c.roughness)});
    Tried made{roughness, {}, w[0] * a.mean + w[1] * b.mean + w[2] * c.mean, {}};
    made.exact.reserve(b.exact.size());
    for (std::size_t k = 0; k < b.exact.size(); ++k) {
        const Vec3f &u = a.exact[k], &v = b.exact[k], &t = c.exact[k];
        made.exact.push_back(
            {interpolate({u.x, v.x, t.x}, w), interpolate({u.y, v.y, t.y}, w), interpolate({u.z, v.z, t.z}, w)});
    }
    made.fit = fit_level(sample_, made.exact);
    return made;
}

/// The fit at a roughness between the neighbours of the best fit, if these are close to it.
LevelSearch::Tried LevelSearch::between(double roughness) const {
    const std::size_t b = best();
    if (b == 0 || b + 1 == tried_.size() || roughness == tried_[b].roughness) return tried_[b];
    const Tried& middle = tried_[b];
    if (tried_[b + 1].roughness - tried_[b - 1].roughness > 3 * k_spacing * middle.roughness) return middle;
    Tried made = interpolated(roughness, b);
    return made.fit.error < middle.fit.error ? made : middle;
}

LevelSearch::Coarse LevelSearch::coarse() const {
    const std::size_t b = best();
    Coarse found{tried_[b].roughness, tried_[b].fit.error};
    if (tried_.size() < 3) return found;
    const std::size_t middle = std::clamp<std::size_t>(b, 1, tried_.size() - 2);
    const double low = tried_[b > 0 ? b - 1 : 0].roughness, high = tried_[std::min(b + 1, tried_.size() - 1)].roughness;
    for (int i = 1; i < k_coarse_steps; ++i) {
        const double r = low + (high - low) * i / k_coarse_steps;
        if (const double error = interpolated(r, middle).fit.error; error < found.error) found = {r, error};
    }
    return found;
}

/// The slope of the squared error over the squared distance from the minimum `at`, measured at its neighbours.
double LevelSearch::growth(double at, double error) const {
    const std::size_t b = best();
    double sum = 0;
    int count = 0;
    for (const std::size_t i : {b - 1, b, b + 1})
        if (i < tried_.size() && std::abs(tried_[i].roughness - at) > 0.3 * k_spacing * at && tried_[i].roughness > 0) {
            sum += (square(tried_[i].fit.error) - square(error)) / square(tried_[i].roughness - at);
            ++count;
        }
    return count > 0 ? sum / count : growth_at_mirror_;
}

LevelSearch::Found LevelSearch::found() const {
    const Tried t = between(minimum());
    Found found;
    found.roughness = t.roughness;
    found.fit = t.fit;
    found.energy = t.mean > 0 ? sample_.mean / t.mean : 1;
    const double e = t.fit.error, limit = 1.05 * e + 5e-4;
    const double at = t.roughness, grows = at == 0 && tried_.size() == 1 ? growth_at_mirror_ : growth(at, e);
    found.within = grows > 0 ? std::min(1.0, std::sqrt((square(limit) - square(e)) / grows)) : 1;
    found.known = found.within < std::max(at - (range_.mirror ? 0 : range_.least), 1 - at);
    return found;
}

}  // namespace domelight
