#include "environment/sky/atmosphere.h"

#include "domelight/base/parallel.h"

#include "environment/sky/spectral_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace domelight::sky {
namespace {

constexpr double k_air_scale = 8.4, k_aerosol_scale = 1.2;                 // scale heights, km
constexpr double k_ozone_middle = 25, k_ozone_half_width = 15;             // a triangle, km
constexpr double k_dobson_units = 300, k_molecules_per_dobson = 2.687e20;  // per m^2
constexpr double k_angstrom_exponent = 1.3, k_single_scattering_albedo = 0.94;
// RGB such that luminance = 179 lm/W x (0.2126 R + 0.7152 G + 0.0722 B), as in the Radiance format (Ward 1994); the
// candela is defined by 683 lm/W.
constexpr double k_efficacy_ratio = 683.0 / 179.0;

constexpr int k_mu_nodes = 160, k_radius_nodes = 48;  // columns
constexpr int k_height_nodes = 16, k_sun_nodes = 20;  // multiple scattering
constexpr int k_gather_polar = 8, k_gather_azimuth = 6, k_gather_steps = 20;

const double k_horizon_distance = std::sqrt(k_top_radius * k_top_radius - k_ground_radius * k_ground_radius);

/// Optical depth of clean air from sea level up; `nm` in nanometres. Bodhaine et al. 1999, eq. 30.
double rayleigh_depth(double nm) {
    const double l2 = nm * nm * 1e-6, i2 = 1 / l2;
    return 0.0021520 * (1.0455996 - 341.29061 * i2 - 0.90230850 * l2) / (1 + 0.0027059889 * i2 - 85.968563 * l2);
}

/// exp(x) for x <= 0, relative error < 3e-7: a polynomial, so that loops over bands become vector code.
inline float exp_negative(float x) {
    const float y = std::max(x, -87.0f) * 1.442695041f;
    const auto n = std::int32_t(y - 0.5f);
    const float f = (y - float(n)) * 0.6931471806f;
    const float p =
        1 + f * (1 + f * (0.5f + f * (1.6666667e-1f + f * (4.1666667e-2f + f * (8.3333333e-3f + f * 1.3888889e-3f)))));
    return p * std::bit_cast<float>((n + 127) << 23);
}

/// Gauss-Legendre nodes and weights on [-1, 1].
void gauss_legendre(int n, double* nodes, double* weights) {
    for (int i = 0; i < n; ++i) {
        double x = std::cos(k_pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 20; ++step) {
            double p0 = 1, p1 = x;
            for (int k = 2; k <= n; ++k) p0 = std::exchange(p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k);
            slope = n * (x * p1 - p0) / (x * x - 1);
            x -= p1 / slope;
        }
        nodes[i] = x;
        weights[i] = 2 / ((1 - x * x) * slope * slope);
    }
}

/// Distance to the top from radius r at cosine mu.
double distance_to_top(double r, double mu) {
    return std::max(0.0, -r * mu + std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + k_top_radius * k_top_radius)));
}

/// Columns over `distance` outward from radius r at cosine mu >= 0, by the midpoint rule in x with t = distance x^2,
/// which is dense where the air is dense.
Columns columns_outward(double r, double mu, double distance, int steps) {
    double air = 0, aerosol = 0, ozone = 0;
    for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps, t = distance * x * x, dt = 2 * distance * x / steps;
        const Columns d = density(std::sqrt(r * r + t * t + 2 * r * t * mu) - k_ground_radius);
        air += d.air * dt;
        aerosol += d.aerosol * dt;
        ozone += d.ozone * dt;
    }
    return {float(air), float(aerosol), float(ozone)};
}

/// One of the directions that multiple scattering is gathered from.
struct GatherDirection {
    double mu, nu, length;    ///< cosines to the zenith and to the sun; length, km
    float weight;             ///< share of the sphere
    float rayleigh, aerosol;  ///< weight times phase function
    bool hits_ground;
};

/// Directions over half a turn of azimuth (the other half is its mirror image), quadratic away from the sun; above and
/// below the horizon separately, and quadratic away from it, because twilight comes from near the horizon.
void gather_directions(double r, double mu_sun, std::span<GatherDirection> out) {
    double node[k_gather_polar], node_weight[k_gather_polar];
    gauss_legendre(k_gather_polar, node, node_weight);
    const double sine_sun = std::sqrt(std::max(0.0, 1 - mu_sun * mu_sun));
    const double horizon = -std::sqrt(std::max(0.0, 1 - k_ground_radius * k_ground_radius / (r * r)));
    double rayleigh = 0, aerosol = 0;
    for (int p = 0; p < 2 * k_gather_polar; ++p) {
        const bool ground = p >= k_gather_polar;
        const double s = 0.5 + 0.5 * node[p % k_gather_polar], span = ground ? -1 - horizon : 1 - horizon;
        const double mu = horizon + span * s * s, sine = std::sqrt(std::max(0.0, 1 - mu * mu));
        const double ring = node_weight[p % k_gather_polar] * std::abs(span) * s / 2;
        const double to_ground =
            -r * mu - std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + k_ground_radius * k_ground_radius));
        for (int q = 0; q < k_gather_azimuth; ++q) {
            const double x = (q + 0.5) / k_gather_azimuth, weight = ring * 2 * x / k_gather_azimuth;
            const double nu = mu * mu_sun + sine * sine_sun * std::cos(k_pi * x * x);
            const double pr = weight * phase_rayleigh(float(nu)), pm = weight * phase_aerosol(float(nu));
            out[p * k_gather_azimuth + q] = {
                mu, nu, ground ? to_ground : distance_to_top(r, mu), float(weight), float(pr), float(pm), ground};
            rayleigh += pr;
            aerosol += pm;
        }
    }
    // So few directions miss much of the aerosol's forward lobe or count it twice, so their sum is scaled to the lobe's
    // true integral.
    for (GatherDirection& d : out) {
        d.rayleigh *= float(1 / (4 * k_pi * rayleigh));
        d.aerosol *= float(1 / (4 * k_pi * aerosol));
    }
}

}  // namespace

Medium::Medium(double turbidity) {
    // D65 white. IEC 61966-2-1.
    constexpr double from_xyz[3][3] = {
        {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
    for (auto& channel : to_rgb) channel.fill(0);
    for (int b = 0; b < k_bands; ++b) {
        const int first = 2 * b, last = b + 1 < k_bands ? first + 2 : k_data_bins;
        double rayleigh_sum = 0, ozone_sum = 0;
        for (int i = first; i < first + 2; ++i) {
            rayleigh_sum += rayleigh_depth(k_data_first_nm + k_data_step_nm * (i + 0.5)) / 2;
            ozone_sum += k_ozone_cross_section[i] * 1e-26 / 2;
        }
        const double nm = k_data_first_nm + k_data_step_nm * (first + 1);
        rayleigh[b] = float(rayleigh_sum / k_air_scale);
        ozone[b] = float(ozone_sum * k_dobson_units * k_molecules_per_dobson / k_ozone_half_width);
        const double depth = (turbidity - 1) * rayleigh_depth(550) * std::pow(nm / 550, -k_angstrom_exponent);
        aerosol_extinction[b] = float(depth / k_aerosol_scale);
        aerosol_scattering[b] = float(k_single_scattering_albedo * depth / k_aerosol_scale);
        double xyz[3] = {0, 0, 0};
        for (int i = first; i < last; ++i)
            for (int c = 0; c < 3; ++c) xyz[c] += k_solar_irradiance[i] * k_observer[c][i] * k_data_step_nm;
        for (int c = 0; c < 3; ++c)
            to_rgb[c][b] =
                float(k_efficacy_ratio * (from_xyz[c][0] * xyz[0] + from_xyz[c][1] * xyz[1] + from_xyz[c][2] * xyz[2]));
    }
}

Vec3f Medium::colour(const Spectrum& relative_to_sun) const {
    double rgb[3] = {0, 0, 0};
    for (int c = 0; c < 3; ++c)
        for (int b = 0; b < k_bands; ++b) rgb[c] += double(to_rgb[c][b]) * relative_to_sun[b];
    const double grey = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], least = std::min({rgb[0], rgb[1], rgb[2]});
    const double keep = least < 0 ? grey / (grey - least) : 1;
    const auto mapped = [&](double v) { return float(std::max(0.0, grey + keep * (v - grey))); };
    return {mapped(rgb[0]), mapped(rgb[1]), mapped(rgb[2])};
}

Columns density(double height) {
    const float h = float(std::max(0.0, height));
    return {exp_negative(-h / float(k_air_scale)), exp_negative(-h / float(k_aerosol_scale)),
            std::max(0.0f, 1 - std::abs(h - float(k_ozone_middle)) / float(k_ozone_half_width))};
}

Columns columns_to_top(double r, double mu, int steps) {
    if (mu >= 0) return columns_outward(r, mu, distance_to_top(r, mu), steps);
    // Down to the point closest to the ground and up again: computed outward from this point in both directions.
    const double tangent = r * std::sqrt(std::max(0.0, 1 - mu * mu));
    return columns_outward(tangent, 0, -r * mu, steps) +
           columns_outward(tangent, 0, distance_to_top(tangent, 0), steps);
}

Spectrum transmittance(const Medium& m, const Columns& c) {
    Spectrum out;
    for (int b = 0; b < k_bands; ++b)
        out[b] = exp_negative(-(m.rayleigh[b] * c.air + m.aerosol_extinction[b] * c.aerosol + m.ozone[b] * c.ozone));
    return out;
}

/// A path: from radius r at cosine mu over `length` km, under a sun at cosine mu_sun from the start's zenith, nu from
/// the ray. `lowest` is the distance along it to the point closest to the ground: 0 for a path that climbs.
struct Atmosphere::Ray {
    double r, mu, length, mu_sun, nu, lowest;

    /// Distance along it of point x of [0, 1]: quadratic away from the lowest point on either side, so dense where the
    /// air is dense.
    double distance(double x) const {
        if (lowest <= 0) return length * x * x;
        if (lowest >= length) return length * (1 - (1 - x) * (1 - x));
        const double y = 2 * x - 1;
        return y < 0 ? lowest * (1 - y * y) : lowest + (length - lowest) * y * y;
    }
};

Atmosphere::Atmosphere(double turbidity, double sun_elevation, double ground_albedo, int threads)
    : medium_(turbidity), sun_elevation_(sun_elevation), ground_albedo_(ground_albedo) {
    make_columns(threads);
    make_multiple_scattering(threads);
}

// Bruneton's parameters: the distance to the top between its extremes at this radius, and the distance to the horizon.
// Both keep the table smooth up to the horizon, where the angle itself would not.
void Atmosphere::make_columns(int threads) {
    columns_.resize(k_mu_nodes * k_radius_nodes);
    parallel_for(k_radius_nodes, threads, [&](int j) {
        const double rho = k_horizon_distance * j / (k_radius_nodes - 1),
                     r = std::sqrt(rho * rho + k_ground_radius * k_ground_radius);
        const double nearest = k_top_radius - r, farthest = rho + k_horizon_distance;
        for (int i = 0; i < k_mu_nodes; ++i) {
            const double d = nearest + (farthest - nearest) * i / (k_mu_nodes - 1);
            const double mu = d > 0 ? (k_horizon_distance * k_horizon_distance - rho * rho - d * d) / (2 * r * d) : 1;
            columns_[j * k_mu_nodes + i] = columns_to_top(r, std::clamp(mu, -1.0, 1.0));
        }
    });
}

Columns Atmosphere::columns(double r, double mu) const {
    const double rho = std::sqrt(std::max(0.0, r * r - k_ground_radius * k_ground_radius));
    const double nearest = k_top_radius - r, farthest = rho + k_horizon_distance;
    const double x = std::clamp((distance_to_top(r, mu) - nearest) / (farthest - nearest), 0.0, 1.0) * (k_mu_nodes - 1);
    const double y = std::clamp(rho / k_horizon_distance, 0.0, 1.0) * (k_radius_nodes - 1);
    const int i = std::min(int(x), k_mu_nodes - 2), j = std::min(int(y), k_radius_nodes - 2);
    const float fx = float(x - i), fy = float(y - j);
    const Columns* at = &columns_[j * k_mu_nodes + i];
    return (at[0] * (1 - fx) + at[1] * fx) * (1 - fy) + (at[k_mu_nodes] * (1 - fx) + at[k_mu_nodes + 1] * fx) * fy;
}

// `visible` becomes the part of the sun's disc above the ground's horizon (a smooth step over its diameter).
Columns Atmosphere::sun_columns(double r, double mu, float* visible) const {
    const double sine = std::min(1.0, k_ground_radius / r), horizon = -std::sqrt(1 - sine * sine);
    const double x = std::clamp(0.5 + 0.5 * (mu - horizon) / (sine * k_sun_radius), 0.0, 1.0);
    *visible = float(x * x * (3 - 2 * x));
    return *visible > 0 ? columns(r, std::max(mu, horizon)) : Columns{};
}

/// Gathers light along the ray. In each step the source at its middle is taken as constant and extinction is integrated
/// exactly (Hillaire 2020, sec. 5.2). `transfer` (if not null) receives the light from a uniform unit source after one
/// scattering (Hillaire's L_f).
Gathered Atmosphere::march(const Ray& ray, int steps, bool with_multiple, Spectrum* transfer) const {
    Gathered out;
    Spectrum through;
    through.fill(1);
    const Medium& m = medium_;
    for (int i = 0; i < steps; ++i) {
        const double x0 = double(i) / steps, x1 = double(i + 1) / steps, xm = 0.5 * (x0 + x1);
        const double t = ray.distance(xm);
        const float dt = float(ray.distance(x1) - ray.distance(x0));
        const double r = std::sqrt(ray.r * ray.r + t * t + 2 * ray.r * t * ray.mu);
        const double mu_sun = (ray.r * ray.mu_sun + t * ray.nu) / r;
        const Columns d = density(r - k_ground_radius);
        float visible;
        const Columns s = sun_columns(r, mu_sun, &visible);
        Spectrum weight, scattering;  // (1 - e^-tau) / tau dt T, and all scattering there
        for (int b = 0; b < k_bands; ++b) {
            const float sigma = m.rayleigh[b] * d.air + m.aerosol_extinction[b] * d.aerosol + m.ozone[b] * d.ozone,
                        tau = sigma * dt;
            const float passed = exp_negative(-tau);
            // Below 1e-3 the difference loses its digits; the series does not.
            weight[b] = through[b] * dt * (tau < 1e-3f ? 1 - 0.5f * tau : (1 - passed) / std::max(tau, 1e-3f));
            through[b] *= passed;
            scattering[b] = weight[b] * (m.rayleigh[b] * d.air + m.aerosol_scattering[b] * d.aerosol);
        }
        if (visible > 0)
            for (int b = 0; b < k_bands; ++b) {
                const float sun =
                    visible * weight[b] *
                    exp_negative(-(m.rayleigh[b] * s.air + m.aerosol_extinction[b] * s.aerosol + m.ozone[b] * s.ozone));
                out.rayleigh[b] += sun * m.rayleigh[b] * d.air;
                out.aerosol[b] += sun * m.aerosol_scattering[b] * d.aerosol;
            }
        if (with_multiple) add_multiple_scattering(r, mu_sun, scattering, out.multiple);
        if (transfer)
            for (int b = 0; b < k_bands; ++b) (*transfer)[b] += scattering[b];
        out.columns = out.columns + d * dt;
    }
    return out;
}

// The second order's in-scattered light is gathered over the sphere; all higher orders are assumed to be isotropic,
// each f times the one before: Psi = L_2 / (1 - f) (Hillaire 2020, eqs. 5 to 10). In contrast to Hillaire, the first
// scattering keeps its phase functions.
Spectrum Atmosphere::multiple_scattering_at(double r, double mu_sun) const {
    std::array<GatherDirection, 2 * k_gather_polar * k_gather_azimuth> directions;
    gather_directions(r, mu_sun, directions);
    Spectrum second{}, share{};
    for (const GatherDirection& d : directions) {
        Spectrum transfer{};
        const Gathered g = march({r, d.mu, d.length, mu_sun, d.nu, -r * d.mu}, k_gather_steps, false, &transfer);
        for (int b = 0; b < k_bands; ++b) {
            second[b] += g.rayleigh[b] * d.rayleigh + g.aerosol[b] * d.aerosol;
            share[b] += d.weight * transfer[b];
        }
        const double ground_mu = (r * mu_sun + d.length * d.nu) / k_ground_radius;
        if (!d.hits_ground || ground_mu <= 0) continue;
        const Spectrum lit = transmittance(medium_, g.columns + columns(k_ground_radius, ground_mu));
        for (int b = 0; b < k_bands; ++b) second[b] += d.weight * lit[b] * float(ground_mu * ground_albedo_ / k_pi);
    }
    for (int b = 0; b < k_bands; ++b) second[b] /= 1 - share[b];
    return second;
}

// Nodes: heights in equal steps of the square root, and the sun elevations that any point in sight of the ground sees.
void Atmosphere::make_multiple_scattering(int threads) {
    const double reach = std::acos(k_ground_radius / k_top_radius) + 0.02;
    multiple_first_ = sun_elevation_ - reach;
    multiple_step_ = 2 * reach / (k_sun_nodes - 1);
    multiple_.resize(k_height_nodes * k_sun_nodes);
    parallel_for(k_height_nodes * k_sun_nodes, threads, [&](int i) {
        const double x = double(i / k_sun_nodes) / (k_height_nodes - 1);
        const double r = k_ground_radius + (k_top_radius - k_ground_radius) * x * x;
        multiple_[i] = multiple_scattering_at(r, std::sin(multiple_first_ + multiple_step_ * (i % k_sun_nodes)));
        // As logarithms: in twilight the light falls to a third with each degree, and linear interpolation between
        // nodes would be visible.
        for (float& v : multiple_[i]) v = std::log(std::max(v, 1e-30f));
    });
}

void Atmosphere::add_multiple_scattering(double r, double mu_sun, const Spectrum& scattering, Spectrum& out) const {
    const double height = std::max(0.0, (r - k_ground_radius) / (k_top_radius - k_ground_radius));
    const double y = std::min(std::sqrt(height), 1.0) * (k_height_nodes - 1);
    // Elevations past the zenith have the sine of those before it, which is what asin returns.
    const double x = std::clamp((std::asin(std::clamp(mu_sun, -1.0, 1.0)) - multiple_first_) / multiple_step_, 0.0,
                                k_sun_nodes - 1.0);
    const int i = std::min(int(x), k_sun_nodes - 2), j = std::min(int(y), k_height_nodes - 2);
    const float fx = float(x - i), fy = float(y - j);
    const Spectrum *a = &multiple_[j * k_sun_nodes + i], *b = a + k_sun_nodes;
    for (int k = 0; k < k_bands; ++k) {
        const float value = (a[0][k] * (1 - fx) + a[1][k] * fx) * (1 - fy) + (b[0][k] * (1 - fx) + b[1][k] * fx) * fy;
        out[k] += scattering[k] * exp_negative(std::min(value, 0.0f));  // no more than the sun's irradiance a steradian
    }
}

Gathered Atmosphere::gather(double elevation, double azimuth, double distance, int steps) const {
    const double mu = std::sin(elevation), mu_sun = std::sin(sun_elevation_);
    const double nu = mu * mu_sun + std::cos(elevation) * std::cos(sun_elevation_) * std::cos(azimuth);
    const double length = std::min(distance, distance_to_top(k_ground_radius, mu));
    return march({k_ground_radius, mu, length, mu_sun, nu, 0}, steps, true, nullptr);
}

}  // namespace domelight::sky
