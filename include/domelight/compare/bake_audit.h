#pragma once
// Anybody's baked specular cube against the exact filter of its source: which way round it is, how rough each level
// really is, how bright, how far off.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// A level of a bake.
struct CubeLevel {
    Cubemap cube;                     ///< RGB radiance, faces in the file's order
    std::optional<double> roughness;  ///< what the file or its format says was baked into it, [0, 1]
};

/// The light that was baked: exactly one of the two.
struct AuditSource {
    ImageView<const float> latlong;  ///< RGB, default convention up to world_to_source
    const Cubemap* cube = nullptr;
    Mat3 world_to_source;  ///< as in Environment
};

/// How a cube is turned against texture(cube, d) = radiance from d: it holds in direction d what ours holds in
/// direction `ours_from_theirs` d.
struct CubeOrientation {
    Mat3 ours_from_theirs;  ///< a signed permutation of the axes
    std::string words;      ///< "as ours", "mirrored in x", "turned by 90 degrees about +Y", ...
    double error = 0;       ///< LevelAudit::error of the level it was found by, [0, 1]
    double next_error = 0;  ///< of the best other orientation
    bool certain = true;    ///< false: the light is so even or symmetric that another orientation fits as well
};
/// The words for one of the 48 orientations.
std::string orientation_words(const Mat3& ours_from_theirs);

/// What was found out about a level. `exact` is the exact filter of the source at `roughness`, in the orientation
/// found; `scale` times it is the best fit to the level.
struct LevelAudit {
    int size = 0;
    double roughness = 0;         ///< of GGX (n = v = r) that fits best; 0: the environment itself
    double roughness_within = 0;  ///< the fit is less than a twentieth worse (or 0.0005) this far from it
    bool roughness_known = true;  ///< false: every roughness fits alike
    double scale = 1;             ///< median over texels of theirs / exact (luminance)
    double energy = 1;  ///< mean over the sphere of theirs over that of exact (luminance), as their texels sample it
    double error =
        0;  ///< RMS over the sphere of (theirs - fit) / max(theirs, fit), [0, 1]: every direction counts alike
    double relative_rmse = 0;  ///< sqrt(sum (theirs - fit)^2 / sum fit^2): the brightest directions count most
    double largest = 0;        ///< of |theirs - fit| / max(theirs, fit)
    std::optional<double> stated_roughness;
    /// At the stated roughness and scale 1: what an engine gets that trusts the file.
    double stated_error = 0, stated_relative_rmse = 0;
};

struct BakeAudit {
    CubeOrientation orientation;
    std::vector<LevelAudit> levels;
};

struct AuditOptions {
    int texels = 6144;  ///< looked at in each level, spread over it evenly at random; all of smaller levels
    int threads = 0;    ///< 0: all
    Progress progress = {};
};

/// Audits a bake. The exact filter is prefilter() at the level's own size, on a ladder of roughnesses that is refined
/// twice about the best; the 48 exchanges and mirrorings of the axes carry texel centres of a cube to texel centres, so
/// nothing is interpolated. Errors: no levels; a level without a finite texel above 0; those of prefilter(). NaN and
/// infinite texels are left out.
Result<BakeAudit> audit_bake(std::span<const CubeLevel> levels, const AuditSource& source,
                             const AuditOptions& options = {});

}  // namespace domelight
