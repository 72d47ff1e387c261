#pragma once
// Texels for bilinear lookups between them: docs/math/prefilter.md, "Texels for lookups between them".

#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/image/image.h"

namespace domelight {

/// Whether a lobe is wide enough, half a texel, for texels other than those at the centres to bring a lookup nearer.
bool gains_by_read_texels(const ZonalKernel& kernel, int size);

/// By how much finer a level has to be filtered for read_texels(): 1 where the second differences of the level itself
/// are enough.
int read_texels_factor(int size);

/// The texels of a cube whose bilinear lookups, seamless across edges, are nearest to filtered light over the sphere, in
/// the sense of least squares weighted by solid angle. No value is negative.
///
/// fine   the light at the centres of a cube with faces of size · read_texels_factor(size) texels
/// size   of a face of the result
Cubemap read_texels(const Cubemap& fine, int size, int threads);

}  // namespace domelight
