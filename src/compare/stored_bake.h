#pragma once
// A bake by any tool, as its files hold it, to be audited.

#include "domelight/compare/bake_audit.h"
#include "domelight/compare/read_error.h"
#include "domelight/engines/engine.h"
#include "domelight/environment/environment.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// A bake as read: its levels, and what it is.
struct StoredBake {
    std::vector<CubeLevel> levels;
    std::string format;
    std::string stated_by;           ///< who says which roughness the levels have
    bool is_cube = false;            ///< a texture with six faces
    const Engine* engine = nullptr;  ///< that a cube is for, where the options or a manifest say it
    Lobe lobe = Lobe::ggx;
    Texels texels = Texels::centre;
    std::function<double(double)> level_of;  ///< by the engine's curve; empty: linear between the levels
};

struct StoredBakeOptions {
    std::string engine;        ///< whose roughness curve the bake should have; empty: what the file states
    std::optional<Lobe> lobe;  ///< empty: what the file states, otherwise ggx
    int threads = 0;
};

/// Reads a texture with its levels, or a picture or folder of faces for each level.
/// Errors: those of reading; an engine that is not known, or that filters by itself.
Result<StoredBake> read_stored_bake(const std::vector<std::string>& files, const StoredBakeOptions& options);

/// The named lat-long convention by which the baker read the source, where that explains the orientation.
std::string convention_of(const Mat3& ours_from_theirs, const Mat3& world_to_source);

/// Whether a cube lies as the engine that it is for reads it; false where the light would be mirrored or tilted. Nothing
/// where no engine is known, where no orientation fits, where the light cannot tell it, or where the light is turned about
/// +Y alone, as by another lat-long convention of the source.
std::optional<bool> lies_as_read(const StoredBake& bake, const BakeAudit& audit);

/// The bake as a shader reads it; nothing where no orientation fits.
Result<std::optional<ReadErrors>> read_errors_of(const StoredBake& bake, const BakeAudit& audit,
                                                 const Environment& environment, int threads);

}  // namespace domelight
