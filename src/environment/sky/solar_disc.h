#pragma once

#include "domelight/base/vec.h"

#include <span>
#include <vector>

namespace domelight::sky {

class SkyModel;

/// The sun's disc: its radiance at each point, and its part in each texel of a lat-long image.
///
/// Limb darkening is Hestroffer and Magnan's (1998) power law, I(mu) = mu^a with a = -0.023 + 0.292 um / lambda, at one
/// wavelength for each channel. The extinction is that at the elevation of each point, so a setting sun is redder at
/// its lower edge. There is no refraction.
class SolarDisc {
  public:
    explicit SolarDisc(const SkyModel& model);

    /// Radiance (W / (m^2 sr)) at an elevation (radians) and at `x` radii from the centre, 0..1.
    Vec3d radiance(double elevation, double x) const;
    /// Adds to the texels of row `y` of a lat-long image (3 channels) the mean radiance over each texel's solid angle,
    /// the disc's centre at `azimuth` (radians). The part of the disc below the horizon is left out.
    void add_to_row(int y, int width, int height, double azimuth, float* row) const;
    /// Integral of radiance over the visible disc, W / m^2.
    Vec3d irradiance() const;

  private:
    Vec3d strip(double elevation, double from, double to) const;

    double elevation_;
    double first_ = 0, step_ = 1;
    std::vector<Vec3d> extinction_;  ///< mean disc radiance at elevations first_ + k step_
};

/// Irradiance on a surface that faces the sun from the visible part of its disc, W / m^2.
Vec3d solar_disc_irradiance(const SkyModel& model);

}  // namespace domelight::sky
