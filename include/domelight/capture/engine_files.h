#pragma once
// The light of a set of probes as the files that engines load.
//
//     auto set = ProbeSet::load("probes");
//     auto files = write_engine_files(*set, "three", "probes/three");

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/probe/probe_set.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace domelight {

struct EngineFilesOptions {
    int threads = 0;                              ///< 0: all
    std::vector<std::filesystem::path> inputs{};  ///< files that must not be overwritten
    Progress progress;
};

struct EngineFilesReport {
    std::vector<std::string> files;   ///< relative to the folder, the one that names the others last
    std::int64_t clipped_texels = 0;  ///< brighter than the file's encoding can hold
};

/// Writes a set for an engine:
///
///     three   light-probe-grid.ktx2, the atlas of three.js' LightProbeGrid (a 3D texture of nine harmonics), and
///             light-probe-grid.json with its place. The set must be a grid.
///     bevy    irradiance-volume.ktx2, the 3D texture of Bevy's IrradianceVolume, and irradiance-volume.json with its
///             transform. The set must be a grid.
///     others  a bake of each valid probe for that engine of `domelight bake --for`, in a folder with the probe's
///             number, and probes.json with the place, box and influence of each.
///
/// docs/probes.md has the formats, and the code that loads them.
///
/// Errors: an engine that does not exist; one that needs a grid, of a set without; no valid probe; those of writing;
/// "cancelled".
Result<EngineFilesReport> write_engine_files(const ProbeSet& set, const std::string& engine,
                                             const std::filesystem::path& folder,
                                             const EngineFilesOptions& options = {});

/// The light at a point as six values of E / pi, for normals along +X, +Y, +Z, -X, -Y and -Z. For a normal n the shader
/// has n.x² c(±X) + n.y² c(±Y) + n.z² c(±Z), of each pair the one on the normal's side (Mitchell, McTaggart and Green
/// 2006, "Shading in Valve's Source Engine", slide 28).
using AmbientCube = std::array<Vec3f, 6>;
/// That sum for a normal of unit length.
Vec3f ambient_cube_at(const AmbientCube& cube, const Vec3f& normal);
/// The cube whose sum is nearest to a probe's E / pi over all normals, in the sense of least squares; none of its values
/// is negative. Light that is the same from everywhere is exact.
AmbientCube fit_ambient_cube(const ProbeSet& set, int probe);

}  // namespace domelight
