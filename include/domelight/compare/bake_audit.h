#pragma once
// Compares a specular cube that any tool baked with the exact filter of its source. The audit reports whether the cube
// is a bake of that source, its orientation, and the roughness, brightness and error of each level.

#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// A level of a bake.
struct CubeLevel {
    Cubemap cube;                         ///< RGB radiance, faces in the file's order
    std::optional<double> roughness;      ///< the roughness that the file or its format states, [0, 1]
    std::optional<double> exponent = {};  ///< the same for a Phong lobe, >= 0; infinity: the environment itself
};

/// The orientation of a cube ("theirs") relative to Domelight's ("ours"), where texture(ours, d) is the radiance from
/// direction d: texture(theirs, d) = texture(ours, ours_from_theirs * d).
struct CubeOrientation {
    Mat3 ours_from_theirs;  ///< a signed permutation of the axes
    std::string words;      ///< "as ours", "mirrored in x", "turned by 90 degrees about +Y", ...
    double error = 0;       ///< LevelAudit::broad_error of level 0 in this orientation, [0, 1]
    double next_error = 0;  ///< the same for the second best orientation
    bool certain = true;    ///< false: the light is so uniform or symmetric that another orientation fits as well
};
/// The words for one of the 48 orientations.
std::string orientation_words(const Mat3& ours_from_theirs);

/// The findings for a level. Below, `exact` is the exact filter of the source at `roughness`, in the orientation found,
/// and `scale` times `exact` is the best fit to the level.
struct LevelAudit {
    int size = 0;
    double roughness = 0;            ///< of the lobe that fits best; 0: the environment itself
    std::optional<double> exponent;  ///< of a Phong lobe that fits best; infinity: the environment itself
    /// Half-width of the interval about `roughness` in which the error of the fit stays below 1.05 error + 0.0005; at
    /// most 1.
    double roughness_within = 0;
    bool roughness_known = true;  ///< false: every roughness fits alike
    double scale = 1;             ///< median over texels of theirs / exact (luminance)
    double energy = 1;  ///< ratio of the means over the sphere, theirs / exact (luminance), both at the level's texels
    double error =
        0;  ///< RMS over the sphere of (theirs - fit) / max(theirs, fit), [0, 1]: every direction counts alike
    double broad_error = 0;    ///< the same with both averaged to faces of at most 32^2, which removes noise and detail
    double relative_rmse = 0;  ///< sqrt(sum (theirs - fit)^2 / sum fit^2): the brightest directions count most
    double largest = 0;        ///< the largest |theirs - fit| / max(theirs, fit)
    std::optional<double> stated_roughness;
    /// The same errors at the stated roughness and scale 1: those of a program that uses the stated roughness.
    double stated_error = 0, stated_relative_rmse = 0;
};

struct BakeAudit {
    Lobe lobe = Lobe::ggx;
    CubeOrientation orientation;
    std::vector<LevelAudit> levels;
    bool of_source = true;           ///< a bake of this source: no level's broad error is above AuditOptions::same
    bool within = true;              ///< every level's error is at most AuditOptions::within
    std::string verdict;             ///< both in words
    std::vector<std::string> notes;  ///< whole sentences, such as that the source is too small for the bake

    bool passed() const { return of_source && within; }
};

struct AuditOptions {
    Lobe lobe = Lobe::ggx;                ///< with which the levels were filtered
    Texels texels_hold = Texels::centre;  ///< what the levels' texels hold, and so those that they are compared with
    /// Texels compared in each level, at least 96: a quarter are the brightest, the others random. A level with fewer
    /// texels is compared whole.
    int texels = 6144;
    double same = 0.25;  ///< a level with a larger LevelAudit::broad_error is one of another environment
    /// The largest error that a level may have, (0, 1]: LevelAudit::stated_error, or LevelAudit::error where the level
    /// states no roughness. Nothing: any error.
    std::optional<double> within = {};
    int threads = 0;  ///< 0: all
    Progress progress = {};
};

/// Audits a bake. NaN and infinite texels are left out.
///
/// The exact filter is prefilter() at the level's own size. Each of the 48 signed permutations of the axes maps the
/// texel centres of a cube to texel centres, so nothing is interpolated. The orientation is found first, on faces
/// averaged to 32 x 32 texels. If no orientation fits, the cube is a bake of another environment, and all figures are
/// those of averaged faces. Otherwise the filter is run once at the stated roughnesses. For levels whose stated
/// roughness is absent or does not fit, it is run at a series of roughnesses, which are compared on averaged faces.
/// Last it is run up to four times near the best roughness of each level. Each run computes all levels that need it.
///
/// Errors: no levels; a level without a finite texel above 0; those of prefilter(); "cancelled".
Result<BakeAudit> audit_bake(std::span<const CubeLevel> levels, const Environment& source,
                             const AuditOptions& options = {});

}  // namespace domelight
