#pragma once

#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include <memory>

namespace domelight {

/// A clear or hazy daylight sky. docs/sky.md names the model and its sources.
struct SkyOptions {
    int height = 512;               ///< the image is 2 height x height
    double sun_elevation_deg = 30;  ///< -18 .. 90
    double sun_azimuth_deg = 30;    ///< from +X towards +Z
    double turbidity = 3;           ///< 1 (pure air) .. 10 (haze)
    double ground_albedo = 0.2;     ///< 0 .. 1
    bool sun_disc = true;           ///< true size (0.533 degrees across) and radiance
    int threads = 0;
};

/// The sky as a row source, so that any size can be written without being in memory. Radiance in W / (m^2 sr), linear
/// Rec. 709.
std::unique_ptr<RowSource> make_sky(const SkyOptions& options);

/// The labelled six-axis environment that shows every orientation mistake: a colour and the axis's name at each of +-X
/// +-Y +-Z, a grid elsewhere, asymmetric so that a mirror shows.
ImageF make_axes_environment(int height);

}  // namespace domelight
