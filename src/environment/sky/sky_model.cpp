#include "environment/sky/sky_model.h"

#include "domelight/base/parallel.h"

#include "environment/sky/solar_disc.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace domelight::sky {
namespace {

constexpr int k_above_nodes = 96, k_below_nodes = 32, k_steps = 56;
constexpr int k_row_nodes = SkyModel::k_azimuths;
// The eye height (km) determines the distance of the ground at each angle below the horizon, and hence the haze in
// front of it; and the distance of the horizon.
constexpr double k_eye_height = 0.05;

/// Elevation (radians) of a node: quadratic, dense at the horizon where the sky changes fastest.
double node_elevation(int i, int nodes) {
    const double x = double(i) / (nodes - 1);
    return k_pi / 2 * x * x;
}

double node_azimuth(int k) {
    return k_pi * k / (SkyModel::k_azimuths - 1);
}

/// Distance (km) along a ray `depression` radians below the apparent horizon to a ground that curves away under an eye
/// at k_eye_height. Depression is counted from that horizon, not from the true one 0.23 degrees above it, so that the
/// image's middle row divides sky and ground.
double ground_distance(double depression) {
    const double r = k_ground_radius + k_eye_height, dip = std::acos(k_ground_radius / r);
    const double down = std::sin(std::min(depression + dip, k_pi / 2));
    return r * down - std::sqrt(std::max(0.0, r * r * (down * down - 1) + k_ground_radius * k_ground_radius));
}

/// Weights of a uniform Catmull-Rom spline's four nodes at fraction f past the second.
void catmull_rom(double f, float* w) {
    w[0] = float(f * (-0.5 + f * (1 - 0.5 * f)));
    w[1] = float(1 + f * f * (-2.5 + 1.5 * f));
    w[2] = float(f * (0.5 + f * (2 - 1.5 * f)));
    w[3] = float(f * f * (-0.5 + 0.5 * f));
}

}  // namespace

SkyModel::SkyModel(const SkyOptions& options)
    : sun_elevation_(options.sun_elevation_deg * k_pi / 180),
      atmosphere_(options.turbidity, sun_elevation_, options.ground_albedo, options.threads),
      above_(std::size_t(k_above_nodes) * k_row),
      below_(std::size_t(k_below_nodes) * k_row) {
    std::vector<Gathered> nodes(k_above_nodes * k_azimuths);
    parallel_for(k_above_nodes, options.threads, [&](int i) {
        for (int k = 0; k < k_azimuths; ++k) {
            Gathered& g = nodes[i * k_azimuths + k];
            g = atmosphere_.gather(node_elevation(i, k_above_nodes), node_azimuth(k), 1e9, k_steps);
            store(above_, i, k, g, Spectrum{});
        }
    });
    const Medium& medium = atmosphere_.medium();
    const Spectrum sky = sky_spectral_irradiance(nodes);
    sky_irradiance_ = Vec3d(medium.colour(sky));
    direct_irradiance_ = solar_disc_irradiance(*this);

    // The ground is Lambertian: albedo / pi times the irradiance of sun and sky.
    const double sine = std::sin(sun_elevation_);
    const Spectrum direct = sine > 0 ? transmittance(medium, columns_to_top(k_ground_radius, sine, 256)) : Spectrum{};
    Spectrum ground;
    for (int b = 0; b < k_bands; ++b)
        ground[b] = float(options.ground_albedo / k_pi) * (sky[b] + float(std::max(0.0, sine)) * direct[b]);
    parallel_for(k_below_nodes, options.threads, [&](int i) {
        const double distance = ground_distance(node_elevation(i, k_below_nodes));
        for (int k = 0; k < k_azimuths; ++k) {
            const Gathered g = atmosphere_.gather(0, node_azimuth(k), distance, k_steps);
            Spectrum seen = transmittance(medium, g.columns);
            for (int b = 0; b < k_bands; ++b) seen[b] *= ground[b];
            store(below_, i, k, g, seen);
        }
    });
}

void SkyModel::store(std::vector<float>& table, int i, int k, const Gathered& light, const Spectrum& extra) {
    const Medium& m = atmosphere_.medium();
    Spectrum rest = light.multiple;
    for (int b = 0; b < k_bands; ++b) rest[b] += extra[b];
    const Vec3f part[3] = {m.colour(light.rayleigh), m.colour(light.aerosol), m.colour(rest)};
    const auto put = [&](int slot) {
        float* out = &table[std::size_t(i) * k_row + slot * k_node];
        for (int p = 0; p < 3; ++p) {
            out[3 * p] = part[p].x;
            out[3 * p + 1] = part[p].y;
            out[3 * p + 2] = part[p].z;
        }
    };
    put(k + 1);
    // The sky is an even function of the azimuth about both ends.
    if (k == 1) put(0);
    if (k == k_azimuths - 2) put(k_azimuths + 1);
}

Spectrum SkyModel::sky_spectral_irradiance(std::span<const Gathered> nodes) const {
    // The trapezium rule in x of node_elevation and in azimuth; the integrand vanishes at both ends of x.
    Spectrum sum{};
    for (int i = 1; i + 1 < k_above_nodes; ++i) {
        const double x = double(i) / (k_above_nodes - 1), e = node_elevation(i, k_above_nodes);
        const double ring = std::sin(e) * std::cos(e) * k_pi * x / (k_above_nodes - 1) * 2 * k_pi / (k_azimuths - 1);
        for (int k = 0; k < k_azimuths; ++k) {
            const Gathered& g = nodes[i * k_azimuths + k];
            const double c = std::sin(e) * std::sin(sun_elevation_) +
                             std::cos(e) * std::cos(sun_elevation_) * std::cos(node_azimuth(k));
            const float w = float(ring * (k == 0 || k == k_azimuths - 1 ? 0.5 : 1)), pr = phase_rayleigh(float(c)),
                        pm = phase_aerosol(float(c));
            for (int b = 0; b < k_bands; ++b) sum[b] += w * (g.rayleigh[b] * pr + g.aerosol[b] * pm + g.multiple[b]);
        }
    }
    return sum;
}

void SkyModel::row(double elevation, bool above, std::span<float> out) const {
    assert(out.size() == k_row);
    const std::vector<float>& table = above ? above_ : below_;
    const int nodes = above ? k_above_nodes : k_below_nodes;
    const double x = std::sqrt(std::clamp(std::abs(elevation) / (k_pi / 2), 0.0, 1.0)) * (nodes - 1);
    const int i = std::min(int(x), nodes - 2);
    float w[4];
    catmull_rom(x - i, w);
    // Beyond an end the spline continues linearly: node -1 = 2 node 0 - node 1.
    if (i == 0) {
        w[1] += 2 * w[0];
        w[2] -= w[0];
        w[0] = 0;
    }
    if (i == nodes - 2) {
        w[2] += 2 * w[3];
        w[1] -= w[3];
        w[3] = 0;
    }
    const float* at[4];
    for (int n = 0; n < 4; ++n) at[n] = &table[std::size_t(std::clamp(i - 1 + n, 0, nodes - 1)) * k_row];
    for (int f = 0; f < k_row; ++f) out[f] = w[0] * at[0][f] + w[1] * at[1][f] + w[2] * at[2][f] + w[3] * at[3][f];
}

SkyModel::Tap SkyModel::tap(double azimuth_from_sun) {
    const double turns = azimuth_from_sun / (2 * k_pi),
                 folded = std::abs(turns - std::round(turns)) * 2;  // 0..1 of half a turn
    const double x = folded * (k_azimuths - 1);
    const int i = std::min(int(x), k_azimuths - 2);
    Tap tap{i * k_node, {}, float(std::cos(azimuth_from_sun))};
    catmull_rom(x - i, tap.weight);
    return tap;
}

Vec3f SkyModel::radiance(const float* row, const Tap& tap, double sine_product, double cosine_product) {
    const float* n = row + tap.first;
    float v[k_node];
    for (int f = 0; f < k_node; ++f)
        v[f] = tap.weight[0] * n[f] + tap.weight[1] * n[k_node + f] + tap.weight[2] * n[2 * k_node + f] +
               tap.weight[3] * n[3 * k_node + f];
    const float c = float(sine_product) + float(cosine_product) * tap.cosine;
    const float pr = phase_rayleigh(c), pm = phase_aerosol(std::min(c, 1.0f));
    // The spline may be slightly negative where the sky is nearly black.
    const auto sum = [&](int k) { return std::max(0.0f, v[k] * pr + v[3 + k] * pm + v[6 + k]); };
    return {sum(0), sum(1), sum(2)};
}

Vec3f SkyModel::radiance(double elevation, double azimuth_from_sun) const {
    float nodes[k_row];
    row(elevation, elevation >= 0, nodes);
    return radiance(nodes, tap(azimuth_from_sun), std::sin(elevation) * std::sin(sun_elevation_),
                    std::cos(elevation) * std::cos(sun_elevation_));
}

Vec3f SkyModel::sun_radiance(double elevation) const {
    Spectrum s =
        transmittance(atmosphere_.medium(), columns_to_top(k_ground_radius, std::max(0.0, std::sin(elevation)), 256));
    const double solid_angle = 4 * k_pi * std::pow(std::sin(k_sun_radius / 2), 2);
    for (float& v : s) v = float(v / solid_angle);
    return atmosphere_.medium().colour(s);
}

}  // namespace domelight::sky
