#pragma once
// How well a baked level and an exactly filtered one agree, under one of the 48 orientations of a cube.

#include "domelight/base/vec.h"
#include "domelight/image/image.h"

#include <span>
#include <vector>

namespace domelight {

/// The signed permutations of the axes, the identity first.
const std::vector<Mat3>& cube_orientations();

/// The texels of a level that are compared.
struct TexelSample {
    int size = 0;
    std::vector<int> texels;       ///< indices into the strip of faces, y · size + x
    std::vector<double> weights;   ///< solid angle divided by the share of texels taken; the sum is about 4π
    std::vector<Vec3f> values;     ///< of the level that is audited; all finite and ≥ 0
    std::vector<float> luminance;  ///< of values
    double mean = 0;               ///< luminance over the sphere, of every finite texel
};
/// All finite texels, or about `most` of them: a quarter are the brightest; for the rest the strip is cut into equal
/// pieces, and one of the other texels is taken from each.
TexelSample sample_texels(const Cubemap& cube, int most, int threads = 0);

/// The same for a cube that is first averaged to faces of at most k_broad_size^2.
TexelSample sample_broadly(const Cubemap& cube, int most, int threads);

constexpr int k_broad_size = 32;
/// The cube averaged to faces of at most `size`^2.
Cubemap averaged_to(const Cubemap& cube, int size, int threads);

/// Mean luminance over the sphere, of the finite texels.
double mean_luminance(const Cubemap& cube, int threads = 0);

/// For each sampled texel, in direction d, the texel of a cube of the same size in direction `m` d.
std::vector<int> turned_texels(const TexelSample& sample, const Mat3& m);

/// The values of these texels of a cube.
std::vector<Vec3f> values_at(const Cubemap& cube, std::span<const int> texels);

struct Fit {
    double scale = 1, error = 1, relative_rmse = 0, largest = 0;  ///< as in LevelAudit
};
/// Fits `exact`, one value for each texel of the sample, to the sample. `scale` 0: the scale is the median ratio, or
/// with `quick` the geometric mean of the ratios, which takes no sorting.
Fit fit_level(const TexelSample& sample, std::span<const Vec3f> exact, double scale = 0, bool quick = false);

}  // namespace domelight
