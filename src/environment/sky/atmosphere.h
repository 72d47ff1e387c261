#pragma once

#include "domelight/base/vec.h"

#include <array>
#include <vector>

namespace domelight::sky {

/// Bands of 20 nm from 380 to 700 nm; for colours the last one represents everything up to 780 nm.
inline constexpr int k_bands = 16;
using Spectrum = std::array<float, k_bands>;

/// The Earth as a sphere and the top of the atmosphere, km.
inline constexpr double k_ground_radius = 6371, k_top_radius = 6471;
/// Half of the sun's 0.533 degrees, radians.
inline constexpr double k_sun_radius = 0.533 / 2 * k_pi / 180;

/// The optical properties of the atmosphere, per band. The densities of air, aerosol and ozone are relative to the
/// place where these values hold.
struct Medium {
    Spectrum rayleigh;            ///< scattering of air at the ground, per km
    Spectrum aerosol_extinction;  ///< of aerosol at the ground, per km
    Spectrum aerosol_scattering;
    Spectrum ozone;  ///< absorption at the layer's middle, per km
    /// Row c gives linear Rec. 709 channel c, W / (m^2 sr), from radiance relative to the sun's irradiance above the
    /// atmosphere (1 / sr per band).
    std::array<Spectrum, 3> to_rgb;

    /// `turbidity` is (tau_air + tau_aerosol) / tau_air at 550 nm, so 1 is pure air.
    explicit Medium(double turbidity);
    /// The colour of a spectrum relative to the sun's. A colour outside Rec. 709 is moved towards the grey of its
    /// luminance until no channel is negative, which keeps the luminance.
    Vec3f colour(const Spectrum& relative_to_sun) const;
};

/// Amounts along a path: km of air and of aerosol at the ground's density, km of ozone at the layer's greatest density.
struct Columns {
    float air = 0, aerosol = 0, ozone = 0;
    Columns operator+(const Columns& b) const { return {air + b.air, aerosol + b.aerosol, ozone + b.ozone}; }
    Columns operator*(float s) const { return {air * s, aerosol * s, ozone * s}; }
};

/// Densities (1 where Medium's values hold) at `height` km.
Columns density(double height);

/// Columns from radius `r` (km) to the top along a ray at cosine `mu` to the zenith that clears the ground. By
/// quadrature, to 1e-4.
Columns columns_to_top(double r, double mu, int steps = 64);

/// Transmittance of a path, per band.
Spectrum transmittance(const Medium& medium, const Columns& columns);

/// Phase functions, per steradian, of the cosine between the sun's direction and the direction looked into (1: into the
/// sun). Rayleigh's, and for aerosol two Henyey-Greenstein lobes: a narrow forward one for the aureole and a broad one
/// (Kattawar 1975).
inline float phase_rayleigh(float c) {
    return float(3 / (16 * k_pi)) * (1 + c * c);
}
inline constexpr float k_forward_g = 0.85f, k_broad_g = 0.25f, k_forward_share = 0.7f;
inline float phase_aerosol(float c) {
    const auto lobe = [c](float g) {
        const float d = 1 + g * g - 2 * g * c;
        return (1 - g * g) * float(1 / (4 * k_pi)) / (d * std::sqrt(d));
    };
    return k_forward_share * lobe(k_forward_g) + (1 - k_forward_share) * lobe(k_broad_g);
}

/// Light gathered along a path, relative to the sun's irradiance above the atmosphere, before the phase functions are
/// applied.
struct Gathered {
    Spectrum rayleigh{};  ///< once scattered by air: times phase_rayleigh
    Spectrum aerosol{};   ///< once scattered by aerosol: times phase_aerosol
    Spectrum multiple{};  ///< scattered twice or more, 1 / sr
    Columns columns;      ///< of the path
};

/// The atmosphere under one sun: computes the light gathered along a path.
///
/// Rays, transmittance and the multiple scattering follow Hillaire 2020 ("A Scalable and Production Ready Sky and
/// Atmosphere Rendering Technique", EGSR), here per wavelength band; the transmittance table's parameters are
/// Bruneton's (2008, 2017).
class Atmosphere {
  public:
    Atmosphere(double turbidity, double sun_elevation, double ground_albedo, int threads);

    const Medium& medium() const { return medium_; }
    /// Light gathered from the ground up to `distance` km (or to the top) along a ray at `elevation` >= 0, `azimuth`
    /// from the sun's (radians).
    Gathered gather(double elevation, double azimuth, double distance, int steps) const;

  private:
    struct Ray;
    Columns columns(double r, double mu) const;
    Columns sun_columns(double r, double mu, float* visible) const;
    Gathered march(const Ray& ray, int steps, bool with_multiple, Spectrum* transfer) const;
    void make_columns(int threads);
    void make_multiple_scattering(int threads);
    Spectrum multiple_scattering_at(double r, double mu_sun) const;
    void add_multiple_scattering(double r, double mu_sun, const Spectrum& scattering, Spectrum& out) const;

    Medium medium_;
    double sun_elevation_, ground_albedo_;
    std::vector<Columns> columns_;
    std::vector<Spectrum> multiple_;
    double multiple_first_ = 0, multiple_step_ = 1;  ///< local sun elevations of multiple_
};

}  // namespace domelight::sky
