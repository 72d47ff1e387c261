#pragma once
// The split sum's BRDF table as a file: the part of a bake that is the same for every environment.

#include "domelight/base/result.h"
#include "domelight/engines/engine.h"
#include "domelight/filtering/brdf/brdf_table.h"
#include "domelight/sampling/sequences.h"
#include "domelight/texture/texture.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace domelight {

struct BrdfFileOptions {
    BrdfForm form = BrdfForm::scale_bias;  ///< what the channels hold; not `none`
    int size = 128;                        ///< width and height, 1 to 4096
    BrdfG g = BrdfG::correlated;
    bool single_precision = false;        ///< 32-bit floats in .ktx2, .ktx, .dds and .exr, which else get half floats
    std::optional<PointSet> points = {};  ///< the points of a Monte Carlo estimate; empty: quadrature, exact to 1e-5
    int threads = 0;
};

/// How the table is read: in words, for files and manifests.
inline constexpr const char* k_brdf_axes = "u = NdotV, v = roughness, texel centres, row 0 is the smoothest";

/// The table with the three channels of brdf_table.h, whatever the form.
ImageF brdf_table(const BrdfFileOptions& options);

/// Such a table as a texture with the channels of the form (2, or 3 for scale_bias_charlie), and with what it holds in
/// its metadata.
Texture brdf_texture(ImageView<const float> table, const BrdfFileOptions& options);

/// ".ktx2", ".ktx", ".dds", ".exr", ".hdr", ".png".
std::span<const std::string> brdf_file_extensions();

/// Writes the table in the format that the file's name ends in. .hdr and .png have three channels: a form of two has 0
/// in the third. .png has 8 bits a channel, the values as they are, without an sRGB curve.
/// Errors: a size outside 1 to 4096; the form `none`; an ending that brdf_file_extensions() does not list; a failure to
/// write.
Result<void> write_brdf_file(const std::filesystem::path& file, const BrdfFileOptions& options);

}  // namespace domelight
