#pragma once
// Lat-long files of a bake, as an audit of cubes takes them.

#include "domelight/filtering/resample/reproject.h"
#include "domelight/image/image.h"

#include <filesystem>
#include <optional>
#include <string>

namespace domelight {

/// The projection that the bake's manifest.json, in the file's folder or the one above it, states for a lat-long file:
/// "latlong/usd". Nothing where there is no manifest, or where it says nothing of the file.
std::optional<std::string> projection_in_manifest(const std::filesystem::path& file);

/// A lat-long level as a cube: each texel is the mean of the level over it. Its faces are as fine as the level at the
/// horizon, a quarter as wide as the image.
Cubemap cube_of_latlong_level(const ProjectedImage& level, int threads);

}  // namespace domelight
