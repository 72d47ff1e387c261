#pragma once

#include "domelight/base/names.h"
#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace domelight {

/// How directions are laid out over a filtered image.
enum class Layout { cube, latlong };
template <>
struct EnumNames<Layout> {
    static constexpr const char* kind = "a layout";
    static constexpr NamedValue<Layout> table[] = {{Layout::cube, "cube"}, {Layout::latlong, "latlong"}};
};

/// What the texels of a filtered cube hold.
enum class Texels {
    centre,  ///< the filtered light in the direction of each texel's centre
    /// For lookups between texels: the values, none negative, whose bilinear interpolation, seamless across the cube's
    /// edges, is nearest to the filtered light over the sphere in the sense of least squares
    read,
};
template <>
struct EnumNames<Texels> {
    static constexpr const char* kind = "a kind of texels";
    static constexpr NamedValue<Texels> table[] = {{Texels::centre, "centre"}, {Texels::read, "read"}};
};

/// One level of a specular chain.
struct LevelSpec {
    int size = 0;         ///< cube: face size; lat-long: height (the width is twice that)
    bool mirror = false;  ///< the environment itself, averaged over each texel; `kernel` is then ignored
    ZonalKernel kernel;
};

/// The least roughness of filtered sheen; lower values are raised to it. Towards roughness 0 Charlie's lobe shrinks to
/// the horizon and its integral to 0 (the Khronos viewer's own level for roughness 0 is black).
inline constexpr double k_charlie_least_roughness = 0.1;

/// A level of GGX or Charlie with alpha = roughness². At roughness 0 it is the environment itself; Charlie's roughness
/// is raised to k_charlie_least_roughness.
LevelSpec glossy_level_spec(Lobe lobe, int size, double roughness);
/// A level of a Phong lobe; the exponent infinity is the environment itself.
LevelSpec phong_level_spec(Lobe lobe, int size, double exponent);
/// The one or the other, of a value that comes from outside. `width`: the roughness of GGX and Charlie, or the exponent
/// of the Phong lobes. Errors: `size` outside 1 to 16384, `roughness` outside 0 to 1, `exponent` below 0.
Result<LevelSpec> level_spec(Lobe lobe, int size, double width);

/// What to compute from an environment.
struct FilterOptions {
    Layout layout = Layout::cube;
    std::vector<LevelSpec> specular;
    /// Not empty: the light in these world directions (any length but 0) is computed in place of whole maps. Each map is
    /// then an image one row high with a pixel for each direction, whatever `layout` and the sizes say. No level may be
    /// the environment itself.
    std::vector<Vec3d> directions;
    /// Of the specular levels of a cube, but for those that are the environment itself or whose lobe is narrower than
    /// half a texel. All else holds the value at the texel's centre.
    Texels texels = Texels::centre;
    int irradiance_size = 0;  ///< face size (cube) or height (lat-long); 0: none
    int sh_bands = 3;         ///< spherical harmonics of the radiance, this many bands; 0: none
    /// Where to look in the source for the light from a world direction. An Environment has a world_to_source of its
    /// own; this matrix is applied to world directions first, and then the environment's.
    Mat3 world_to_source;
    int threads = 0;  ///< 0: all
    Progress progress;
};

/// A level of filtered light in either layout: RGB float32 radiance.
///
///     for (int f = 0; f < map.faces(); ++f)  // six of a cube, or the one lat-long image
///         upload(map.face(f));
struct FilteredMap {
    Layout layout = Layout::cube;
    /// The lat-long image in the default convention; or the faces of a cube in Cubemap's order and orientation, one
    /// below the other.
    ImageF image;

    FilteredMap() = default;
    FilteredMap(Layout layout_, ImageF image_) : layout(layout_), image(std::move(image_)) {}
    FilteredMap(Cubemap cube) : image(std::move(cube).take_strip()) {}

    bool empty() const { return image.empty(); }
    int faces() const { return layout == Layout::cube ? 6 : 1; }
    int width() const { return image.width(); }              ///< of a face
    int height() const { return image.height() / faces(); }  ///< of a face
    ImageView<float> face(int f) { return image.view().rows(f * height(), height()); }
    ImageView<const float> face(int f) const { return image.view().rows(f * height(), height()); }
    std::span<float> pixels() { return image.pixels(); }
    std::span<const float> pixels() const { return image.pixels(); }
    /// The map as a cube: a copy, or the pixels themselves where the map is given up. The layout must be `cube`.
    Cubemap cube() const& { return Cubemap(image); }
    Cubemap cube() && { return Cubemap(std::move(image)); }
};

/// World direction (unit length) of the centre of texel (x, y) of FilteredMap::image.
///
/// width, height   of one face
Vec3d map_direction(Layout layout, int width, int height, int x, int y);

struct FilterResult {
    std::vector<FilteredMap> specular;  ///< one for each LevelSpec
    FilteredMap irradiance_over_pi;     ///< E / pi
    /// Radiance coefficients a_lm at index l^2 + l + m, real orthonormal basis without the Condon-Shortley sign, in
    /// world space. The axis of the basis is +Z as in Ramamoorthi and Hanrahan 2001; docs/conventions.md lists the
    /// polynomials.
    std::vector<Vec3d> sh;
    Vec3d mean;  ///< mean radiance over the sphere, of the bilinear reconstruction
    /// Texels whose value came out negative because the expansion in harmonics is truncated; they were set to 0.
    std::int64_t clamped = 0;
    int band_limit = 0;  ///< highest degree that was used
};

/// Checks options that come from outside. prefilter() itself expects valid ones.
///
/// Errors, each with the field in its `where`: a level's `size` outside 1 to 16384 (lat-long maps: height); `alpha` of
/// GGX or Charlie outside (0, 1]; a Phong `exponent` that is negative or not finite; a direction that is zero or not
/// finite, or directions together with a level that is the environment itself; `irradiance_size` outside 0 to 4096;
/// `sh_bands` outside 0 to 64; `world_to_source` that is not orthogonal; `threads` outside 0 to 1024.
Result<void> check_filter_options(const FilterOptions& options);

/// The exact prefilter: every level is the environment convolved with its kernel. The relative RMS error is at most
/// 7e-4 for the chains that README.md lists under "How exact". The source is the bilinear reconstruction of the texels
/// (u wraps, v clamps in the half rows at the poles). docs/math/prefilter.md. Errors: those of reading the source;
/// "cancelled".
Result<FilterResult> prefilter(const Environment& environment, const FilterOptions& options);
/// The same for the rows of a lat-long image, which are read once. The light from world direction d is where the
/// default convention has the direction FilterOptions::world_to_source * d.
Result<FilterResult> prefilter(RowSource& source, const FilterOptions& options);
/// The same for a cube: the light from world direction d is where the cube has the direction
/// FilterOptions::world_to_source * d. Errors: "cancelled".
Result<FilterResult> prefilter(const Cubemap& source, const FilterOptions& options);

}  // namespace domelight
