#pragma once
// The files of a bake that are not plain chains of texels: engines' own containers, and OpenEXR with levels.

#include "bake/outputs.h"

namespace domelight {

/// Whether a container is written by write_engine_file().
bool is_engine_file(Container container);

/// Encodes a chain now and writes it in the background. As write_map(); `levels` are mirrored and turned already.
void write_engine_file(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                       const BakeOptions& options, const std::filesystem::path& path, Background& background);

}  // namespace domelight
