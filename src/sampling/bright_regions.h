#pragma once

#include "domelight/sampling/light_extraction.h"

#include "sampling/texel_sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace domelight {

/// The texels of a small bright source, and the luminance that no texel around them exceeds.
struct BrightRegion {
    std::vector<std::int64_t> texels;
    double peak = 0;         ///< luminance
    double rim = 0;          ///< luminance: the level down to which it was followed
    double power = 0;        ///< luminance above `rim` times solid angle
    bool stands_out = true;  ///< from the mean of the surroundings, by the least contrast
};

struct BrightRegions {
    std::vector<BrightRegion> regions;  ///< the largest power first; no two share a texel
    int sources = 0;                    ///< their number before close ones were merged
};

/// Finds the small bright sources.
///
/// luminance  one for each texel
/// mean       of the luminance over the sphere
BrightRegions find_bright_regions(const TexelSphere& sphere, std::span<const float> luminance, double mean,
                                  const LightExtractionOptions& options);

}  // namespace domelight
