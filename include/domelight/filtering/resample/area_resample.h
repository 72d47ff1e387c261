#pragma once

#include "domelight/image/image.h"
#include "domelight/base/vec.h"

#include <memory>

namespace domelight {

/// Averages a lat-long image's bilinear reconstruction over the texels of a cube or of another lat-long image, by exact
/// overlap: every texel is (1 / omega) int g d omega over its own solid angle, so the sum over texels keeps the mean
/// radiance and a constant stays constant.
///
/// Rows are handed in from the top down, any number at a time; finish() may be called once, after the last.
class AreaResampler {
  public:
    virtual ~AreaResampler() = default;
    /// The next rows (source width, 3 channels).
    virtual void add_rows(ImageView<const float> rows) = 0;
    /// The cube's strip (size x 6 size) or the lat-long image.
    virtual ImageF finish() = 0;
};

/// To a cube of `size`^2 faces. `world_to_source` as in Environment: any orthogonal matrix. Where the source's polar
/// axis is an axis of the cube (any rotation about it, any mirror) rows stream through a short window; other
/// orientations keep the whole source and are some 300 times slower.
std::unique_ptr<AreaResampler> area_resample_to_cube(int width, int height, int size, const Mat3& world_to_source,
                                                     int threads);
/// To a lat-long image 2 out_height x out_height. Likewise fast where both images have the same polar axis, either way
/// up.
std::unique_ptr<AreaResampler> area_resample_to_latlong(int width, int height, int out_height,
                                                        const Mat3& world_to_source, int threads);
/// From a cube, whose source is the bilinear reconstruction that continues across edges, to another size and
/// orientation. Mean kept likewise. The same size, with axes only exchanged or mirrored, returns the texels themselves,
/// moved: averaging would blur them a little for nothing.
Cubemap area_resample_cube(const Cubemap& source, int size, const Mat3& world_to_source, int threads);
ImageF area_resample_cube_to_latlong(const Cubemap& source, int out_height, const Mat3& world_to_source, int threads);

}  // namespace domelight
