#pragma once
// The error of a chain as a shader reads it: between texels and between levels, not only at texel centres.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/prefilter.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace domelight {

/// The levels of a specular chain, and how a shader reads them. Within a level a lookup is bilinear: a cube's goes on
/// across the edges of its faces, and where three faces meet the missing fourth texel is the mean of the three (OpenGL's
/// seamless cube maps); a lat-long map's wraps around in u and is clamped in v. Between two levels it is linear in the
/// level.
struct ReadChain {
    Lobe lobe = Lobe::ggx;            ///< ggx or charlie
    std::vector<FilteredMap> levels;  ///< the texels as they are stored and decoded: RGB radiance
    std::vector<double> roughness;    ///< of each level, [0, 1], rising; 0: the environment itself
    /// The level, from 0 to the last and anywhere between, that the shader reads for a roughness. Empty: the level that
    /// is linear in the roughness between neighbouring levels.
    std::function<double(double roughness)> level_of;
    /// The chain is looked up in direction map_from_world * d for the light about world direction d.
    Mat3 map_from_world;
};

struct ReadErrorOptions {
    /// Random directions, at least 2. Half are uniform over the sphere; a quarter are drawn in proportion to the light,
    /// and a quarter in proportion to the light filtered with GGX at roughness 0.15, because uniform ones alone would
    /// miss a sun. The figures weight each by its density, so they are those of uniform directions.
    int directions = 8192;
    int roughnesses = 24;          ///< random roughnesses, one in each of as many equal parts of the range; at least 1
    double least_roughness = 0.1;  ///< the range is from here to 1; (0, 1)
    std::uint64_t seed = 1;        ///< of the directions and the roughnesses
    int threads = 0;               ///< 0: all
    Progress progress = {};
};

/// The error of the lookups for one roughness, over the directions.
struct ReadErrorAt {
    double roughness = 0;
    double level = 0;          ///< that was read
    double relative_rmse = 0;  ///< sqrt(∑ w |read - truth|² / ∑ w |truth|²) over directions and channels
    double largest = 0;        ///< the largest |read - truth| / max(truth, 1 % of the mean) of a channel
};

struct ReadErrors {
    double relative_rmse = 0;  ///< the root mean square of `between`: every roughness counts alike
    double largest = 0;        ///< the largest of `between`
    /// The levels whose own roughness lies in the range and which some roughness up to 1 reads, each read alone at its
    /// own roughness.
    std::vector<ReadErrorAt> levels;
    std::vector<ReadErrorAt> between;  ///< the random roughnesses, rising, by whatever level the shader reads
};

/// Measures a chain against the exact filter of its environment, which is evaluated in each direction for each
/// roughness. The same arguments give the same figures on any number of threads.
///
/// Errors: no levels, or not one roughness for each; a lobe other than ggx or charlie; options out of range; those of
/// reading the environment; "cancelled".
Result<ReadErrors> measure_as_read(const ReadChain& chain, const Environment& environment,
                                   const ReadErrorOptions& options = {});

}  // namespace domelight
