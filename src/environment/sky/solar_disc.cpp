#include "environment/sky/solar_disc.h"

#include "environment/sky/sky_model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight::sky {
namespace {

// Limb darkening exponents at 610, 550 and 465 nm.
constexpr double k_limb[3] = {-0.023 + 0.292 / 0.610, -0.023 + 0.292 / 0.550, -0.023 + 0.292 / 0.465};
constexpr int k_extinction_nodes = 65;

struct Node {
    double at, weight;
};

constexpr std::array<Node, 3> k_gauss_3{{{-0.774596669241483, 5.0 / 9}, {0, 8.0 / 9}, {0.774596669241483, 5.0 / 9}}};
constexpr std::array<Node, 12> k_gauss_12{{{-0.981560634246719, 0.047175336386512},
                                           {-0.904117256370475, 0.106939325995318},
                                           {-0.769902674194305, 0.160078328543346},
                                           {-0.587317954286617, 0.203167426723066},
                                           {-0.367831498998180, 0.233492536538355},
                                           {-0.125233408511469, 0.249147045813403},
                                           {0.125233408511469, 0.249147045813403},
                                           {0.367831498998180, 0.233492536538355},
                                           {0.587317954286617, 0.203167426723066},
                                           {0.769902674194305, 0.160078328543346},
                                           {0.904117256370475, 0.106939325995318},
                                           {0.981560634246719, 0.047175336386512}}};

double square(double x) {
    return x * x;
}

/// Half the azimuth (0..pi) over which the circle of latitude `e` lies on a disc centred at elevation `centre`.
double half_width(double e, double centre) {
    const double room = square(std::sin(k_sun_radius / 2)) - square(std::sin((e - centre) / 2));
    if (room <= 0) return 0;
    const double cosines = std::cos(e) * std::cos(centre);
    return cosines <= room ? k_pi : 2 * std::asin(std::sqrt(room / cosines));
}

/// Calls f(elevation, weight) for quadrature nodes over the part [from, to] of the disc at `centre` (weights include
/// cos e, for solid angles).
///
/// Integrated separately between the nodes of the extinction table, which is linear there: near the horizon it is so
/// steep that a rule across its nodes would give a different sum for each grid of texels. Pieces at the disc's ends,
/// where its width behaves like a square root, use e = middle + half sin(pi s / 2), which makes it smooth in s.
template <typename F>
void for_each_latitude(double centre, double from, double to, F f) {
    const double first = centre - k_sun_radius, step = 2 * k_sun_radius / (k_extinction_nodes - 1);
    // Above k_pi - centre - radius the whole circle of latitude is on the disc (the zenith is on it), which is another
    // square root.
    const double full = k_pi - centre - k_sun_radius;
    const auto between = [&](double low, double high, bool rooted) {
        const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
        if (half <= 0) return;
        if (!rooted)
            for (const Node& n : k_gauss_3) f(middle + half * n.at, n.weight * half * std::cos(middle + half * n.at));
        else
            for (const Node& n : k_gauss_12) {
                const double e = middle + half * std::sin(k_pi / 2 * n.at);
                f(e, n.weight * half * (k_pi / 2) * std::cos(k_pi / 2 * n.at) * std::cos(e));
            }
    };
    const int begin = std::clamp(int((from - first) / step), 0, k_extinction_nodes - 2);
    for (int i = begin; i < k_extinction_nodes - 1 && first + i * step < to; ++i) {
        const double low = std::max(from, first + i * step),
                     high = i == k_extinction_nodes - 2 ? to : std::min(to, first + (i + 1) * step);
        const double split = std::clamp(full, low, high);
        const bool rooted = i < 2 || i >= k_extinction_nodes - 3 || std::abs(0.5 * (low + high) - full) < 2.5 * step;
        between(low, split, rooted);
        between(split, high, rooted);
    }
}

}  // namespace

SolarDisc::SolarDisc(const SkyModel& model) : elevation_(model.sun_elevation()) {
    first_ = elevation_ - k_sun_radius;
    step_ = 2 * k_sun_radius / (k_extinction_nodes - 1);
    if (elevation_ < -k_sun_radius) return;
    for (int i = 0; i < k_extinction_nodes; ++i) extinction_.push_back(Vec3d(model.sun_radiance(first_ + i * step_)));
}

Vec3d SolarDisc::radiance(double elevation, double x) const {
    if (extinction_.empty() || elevation < 0 || x > 1) return {};
    const double at = std::clamp((elevation - first_) / step_, 0.0, k_extinction_nodes - 1.0);
    const int i = std::min(int(at), k_extinction_nodes - 2);
    const Vec3d mean = extinction_[i] * (1 - (at - i)) + extinction_[i + 1] * (at - i);
    // mu^a with mu = sqrt(1 - x^2); its mean over the disc is 2 / (a + 2).
    const double log_mu = 0.5 * std::log(std::max(1 - x * x, 1e-30));
    const auto limb = [&](int c) { return (k_limb[c] + 2) / 2 * std::exp(k_limb[c] * log_mu); };
    return {mean.x * limb(0), mean.y * limb(1), mean.z * limb(2)};
}

/// Integral of radiance over azimuths [from, to] (from the centre's, inside the disc) at one elevation.
Vec3d SolarDisc::strip(double elevation, double from, double to) const {
    const double half = half_width(elevation, elevation_);
    // phi = half sin(pi s / 2): smooth at the limb, as above.
    const double s0 = std::asin(std::clamp(from / half, -1.0, 1.0)) * 2 / k_pi,
                 s1 = std::asin(std::clamp(to / half, -1.0, 1.0)) * 2 / k_pi;
    const double middle = 0.5 * (s0 + s1), width = 0.5 * (s1 - s0);
    const double base = square(std::sin((elevation - elevation_) / 2)),
                 cosines = std::cos(elevation) * std::cos(elevation_);
    Vec3d sum;
    const auto add = [&](const Node& n) {
        const double s = k_pi / 2 * (middle + width * n.at), phi = half * std::sin(s);
        const double x = std::sqrt(base + cosines * square(std::sin(phi / 2))) / std::sin(k_sun_radius / 2);
        sum += radiance(elevation, std::min(x, 1.0)) * (n.weight * width * (k_pi / 2) * std::cos(s) * half);
    };
    if (width < 0.06 && std::max(std::abs(s0), std::abs(s1)) < 0.9)
        for (const Node& n : k_gauss_3) add(n);
    else
        for (const Node& n : k_gauss_12) add(n);
    return sum;
}

void SolarDisc::add_to_row(int y, int width, int height, double azimuth, float* row) const {
    const double top = k_pi / 2 - k_pi * y / height, bottom = k_pi / 2 - k_pi * (y + 1) / height;
    const double from = std::max({bottom, elevation_ - k_sun_radius, 0.0}),
                 to = std::min(top, elevation_ + k_sun_radius);
    if (from >= to || extinction_.empty()) return;
    const double texel = 2 * k_pi / width, solid_angle = texel * (std::sin(top) - std::sin(bottom));
    const double centre = (0.5 + azimuth / (2 * k_pi)) * width;  // in texels
    std::vector<Vec3d> sums(width);
    for_each_latitude(elevation_, from, to, [&](double e, double weight) {
        const double half = half_width(e, elevation_);
        if (half <= 0) return;
        const int first = int(std::floor(centre - half / texel)), last = int(std::floor(centre + half / texel));
        for (int x = first; x <= last; ++x) {
            const double p = std::max((x - centre) * texel, -half), q = std::min((x + 1 - centre) * texel, half);
            if (q > p)
                sums[((x % width) + width) % width] += strip(e, p, q) * weight;
        }
    });
    for (int x = 0; x < width; ++x) {
        row[3 * x] += float(sums[x].x / solid_angle);
        row[3 * x + 1] += float(sums[x].y / solid_angle);
        row[3 * x + 2] += float(sums[x].z / solid_angle);
    }
}

Vec3d SolarDisc::irradiance() const {
    const double from = std::max(elevation_ - k_sun_radius, 0.0), to = std::min(elevation_ + k_sun_radius, k_pi / 2);
    Vec3d sum;
    if (from >= to || extinction_.empty()) return sum;
    for_each_latitude(elevation_, from, to, [&](double e, double weight) {
        const double half = half_width(e, elevation_);
        if (half > 0) sum += strip(e, -half, half) * weight;
    });
    return sum;
}

Vec3d solar_disc_irradiance(const SkyModel& model) {
    return SolarDisc(model).irradiance();
}

}  // namespace domelight::sky
