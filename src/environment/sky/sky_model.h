#pragma once

#include "domelight/environment/sky/sky.h"

#include "environment/sky/atmosphere.h"

#include <span>
#include <vector>

namespace domelight::sky {

/// The sky as seen from the ground, as smooth tables over elevation and azimuth from the sun; evaluated by
/// interpolation.
///
/// The tables hold the light once scattered by air and by aerosol without their phase functions, which are applied
/// exactly on evaluation, and the rest of the light. Both are smooth enough for a few thousand nodes.
class SkyModel {
  public:
    explicit SkyModel(const SkyOptions& options);

    /// Azimuth nodes over half a turn, with a ghost on either side; floats a node: air rgb, aerosol rgb, rest rgb, and
    /// padding.
    static constexpr int k_azimuths = 33, k_node = 12, k_row = (k_azimuths + 2) * k_node;
    /// The table's row at an elevation (radians): k_row floats. `above` distinguishes the sides of the horizon at
    /// elevation 0.
    void row(double elevation, bool above, std::span<float> out) const;
    /// Places an azimuth (radians from the sun's) among a row's nodes.
    struct Tap {
        int first;  ///< float offset of the first of four nodes
        float weight[4];
        float cosine;  ///< of the azimuth
    };
    static Tap tap(double azimuth_from_sun);
    /// Radiance, W / (m^2 sr), without the sun's disc.
    static Vec3f radiance(const float* row, const Tap& tap, double sine_product, double cosine_product);

    /// Radiance in a direction (elevation and azimuth from the sun's, radians) without the disc.
    Vec3f radiance(double elevation, double azimuth_from_sun) const;
    /// The mean radiance, W / (m^2 sr), of the sun's disc at this elevation (radians).
    Vec3f sun_radiance(double elevation) const;
    /// On a horizontal surface from the sky alone, W / m^2.
    Vec3d sky_irradiance() const { return sky_irradiance_; }
    /// On a surface that faces the sun from its disc alone, W / m^2; none of the part below the horizon.
    Vec3d direct_normal_irradiance() const { return direct_irradiance_; }
    double sun_elevation() const { return sun_elevation_; }
    const Atmosphere& atmosphere() const { return atmosphere_; }

  private:
    Spectrum sky_spectral_irradiance(std::span<const Gathered> nodes) const;
    void store(std::vector<float>& table, int elevation_node, int azimuth_node, const Gathered& light,
               const Spectrum& extra);

    double sun_elevation_;
    Atmosphere atmosphere_;
    std::vector<float> above_, below_;  ///< k_row floats for each elevation node
    Vec3d sky_irradiance_, direct_irradiance_;
};

}  // namespace domelight::sky
