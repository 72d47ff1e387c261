#pragma once

#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include <memory>

namespace domelight {

/// Averages a lat-long image's bilinear reconstruction over the texels of a cube or of another lat-long image, by exact
/// overlap: every texel is (1/ω) ∫ g dω over its own solid angle ω, so the mean radiance is kept and a constant stays
/// constant.
///
/// Rows are added from the top down, any number at a time. finish() may be called once, after the last row.
class AreaResampler {
  public:
    virtual ~AreaResampler() = default;
    /// The next rows (source width, 3 channels).
    virtual void add_rows(ImageView<const float> rows) = 0;
    /// The cube's strip (size x 6 size) or the lat-long image.
    virtual ImageF finish() = 0;
};

/// To a cube whose faces have size x size texels. `world_to_source` as in Environment: any orthogonal matrix. Where the
/// source's polar axis is an axis of the cube (whatever the rotation about it and the mirroring), only a short window
/// of rows is kept in memory. Any other orientation needs the whole source in memory and takes about 300 times as long.
std::unique_ptr<AreaResampler> area_resample_to_cube(int width, int height, int size, const Mat3& world_to_source,
                                                     int threads);
/// To a lat-long image of 2 out_height x out_height texels. This is fast if both images have the same polar axis, in
/// the same or in opposite directions.
std::unique_ptr<AreaResampler> area_resample_to_latlong(int width, int height, int out_height,
                                                        const Mat3& world_to_source, int threads);
/// From a cube, reconstructed bilinearly across its edges, to another size and orientation. The mean is kept. If the
/// size stays the same and axes are only exchanged or mirrored, the texels are moved unchanged, because averaging would
/// blur them for no gain. If axes are only exchanged or mirrored, 1024^2 texels from 512^2 take 0.25 s of CPU time; any
/// other orientation takes about 70 times as long.
Cubemap area_resample_cube(const Cubemap& source, int size, const Mat3& world_to_source, int threads);
/// The same to a lat-long image of 2 out_height x out_height texels: 0.22 s of CPU time for faces of 512^2 texels and an
/// image as fine, if its polar axis is an axis of the cube. Any other orientation takes about 40 times as long.
ImageF area_resample_cube_to_latlong(const Cubemap& source, int out_height, const Mat3& world_to_source, int threads);

}  // namespace domelight
