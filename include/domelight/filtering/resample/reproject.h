#pragma once

#include "domelight/base/progress.h"
#include "domelight/image/image.h"
#include "domelight/projection/projections.h"

namespace domelight {

/// A picture of light in any projection: its charts one below the other (a cube: a strip of faces), each `width` x
/// `height` texels, RGB float radiance, finite.
struct ProjectedImage {
    Projection projection;
    ImageF pixels;
    int width() const { return pixels.width(); }
    int height() const { return pixels.height() / projection.charts(); }
};

/// A copy of a cube of radiance as a picture. `world_to_cube` turns world directions into the cube's frame.
ProjectedImage projected_cube(const Cubemap& cube, const Mat3& world_to_cube = {});

/// Radiant power per channel that arrives from all directions: sum of radiance times the texels' solid angles
/// (W / m^2 for radiance in W / (m^2 sr)).
Vec3d radiant_power(const ProjectedImage& image, int threads = 0);

/// The same light in another projection, in charts of width x height texels.
///
/// The reprojection is conservative. Within each source texel the radiance is modelled as a slope-limited parabola
/// along each axis whose mean is the texel's value, and every target texel is the mean over its own solid angle, by
/// exact overlap of the texels' outlines in the source picture (docs/convert.md). So power is kept, a constant stays
/// constant, no negative value appears, and reducing does not alias. Texels that lie across a seam, a pole or a disc's
/// rim are supersampled. Directions that a partial projection leaves out are black; the cone hidden behind a mirror
/// ball repeats the rim. The bytes are the same on any number of threads.
ProjectedImage reproject(const ProjectedImage& source, const Projection& target, int width, int height, int threads = 0,
                         const Progress& progress = {});

}  // namespace domelight
