#pragma once
// How well a baked level and an exactly filtered one agree, under one of the 48 orientations of a cube.

#include "domelight/image/image.h"
#include "domelight/base/vec.h"

#include <array>
#include <vector>

namespace domelight {

/// The signed permutations of the axes, the identity first.
const std::vector<Mat3>& cube_orientations();

/// Texels of a level that are looked at.
struct TexelSample {
    int size = 0;
    std::vector<int> texels;       ///< indices into the strip, y size + x
    std::vector<double> weights;   ///< solid angle over the share of texels taken: they add up to about 4 pi
    std::vector<Vec3f> values;     ///< theirs; all finite and >= 0
    std::vector<float> luminance;  ///< of values
    double mean = 0;               ///< luminance over the sphere, of every finite texel
};
/// All finite texels, or `most` of them, one from each of as many pieces of the strip.
TexelSample sample_texels(const Cubemap& cube, int most);

/// Mean luminance over the sphere, of the finite texels.
double mean_luminance(const Cubemap& cube);

/// For each sampled texel, the one of a cube of the same size that lies in direction `m` d.
std::vector<int> turned_texels(const TexelSample& sample, const Mat3& m);

struct Fit {
    double scale = 1, error = 1, relative_rmse = 0, largest = 0;  ///< as in LevelAudit
};
/// Of the sample against `exact` (same size), its texels picked by turned_texels(). `scale` 0: found as the median
/// ratio; `quick`: as the geometric mean, for choosing among many.
Fit fit_level(const TexelSample& sample, const Cubemap& exact, const std::vector<int>& turned, double scale = 0,
              bool quick = false);

}  // namespace domelight
