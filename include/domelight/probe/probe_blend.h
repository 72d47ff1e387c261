#pragma once
// The light at any point of a scene, from the probes around it.
//
//     const ProbeBlender blender(set);
//     const ProbeBlend near = blender.at(point, normal);
//     Vec3f diffuse = blender.irradiance_over_pi(near, normal);
//     Vec3f glossy = blender.radiance(near, point, reflected, 0.3f);

#include "domelight/probe/probe_set.h"
#include "domelight/probe/tetrahedra.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace domelight {

struct BlendOptions {
    /// The most probes that are blended at a point, 1 .. 8. With fewer than meet there, those of the largest weights are
    /// taken, less the largest weight that is left out: so a probe enters and leaves the blend with weight 0. With 1,
    /// the picture has steps.
    int most = 8;
    /// Probes that are invalid or that a wall hides from the point get no weight, and those behind the surface little.
    /// Without it all probes of a cell count, as in engines that know no visibility, and light leaks through walls.
    bool visibility = true;
    /// The point is moved along the normal by this part of the grid's spacing, on each axis by that axis'
    /// own, before its cell is looked up, 0 .. 1. 0.5 is three.js' LightProbeGrid. Without a grid it is not moved.
    float normal_offset = 0;
    /// Lookups by direction are corrected for the probe's distance from the point, where the probe has a proxy.
    bool parallax = true;
};

/// Probes and their weights: each above 0, sum 1.
struct ProbeBlend {
    struct Part {
        int probe = 0;
        float weight = 0;
    };
    std::array<Part, 8> parts;
    int count = 0;

    std::span<const Part> all() const& { return {parts.data(), std::size_t(count)}; }
    std::span<const Part> all() const&& = delete;  // it would refer to a blend that is gone
};

/// The direction in which to look up a probe's cube for what `point` sees in `direction`, if the walls are those of the
/// box: from the probe to where the ray leaves the box. A point outside the box is first moved to the nearest point in
/// it, so that the result is continuous. Lagarde and Zanuttini 2012, "Local image-based lighting with parallax-corrected
/// cubemaps". Not of unit length.
Vec3f parallax_direction(const ProbeBox& proxy, const Vec3f& probe, const Vec3f& point, const Vec3f& direction);

/// How much of the lobe about the direction of a point reaches it, [0, 1]: Chebyshev's inequality on the distances to
/// the first surface in it. Donnelly and Lauritzen 2006, "Variance shadow maps", eq. 5; Majercik et al. 2019, "Dynamic
/// diffuse global illumination with ray-traced irradiance fields", 5.2, who also cube it. Values below a thousandth
/// become 0. distance: of the point, metres.
float chebyshev_visibility(const DistanceMoments& moments, float distance);

/// Interpolates a set of probes. The set must outlive it; all functions are safe from several threads at once.
///
/// The weight of a probe at a point with a normal is the product of
///   - its interpolation weight: trilinear in the cell of the grid; or barycentric in the tetrahedron, falling to 0 at
///     twice the distance of the second nearest probe;
///   - its validity, 0 or 1, and its influence, which falls to 0 at the boundary of its box or sphere;
///   - chebyshev_visibility() of the point;
///   - ((1 + cos)/2)^2 + 1/50, cos between the normal and the direction to the probe (Majercik et al. 2019 add 1/5).
/// Where little of the weight is left, because walls hide all the probes of a cell or they are invalid, the nearest valid
/// probes fill the blend: the weights stay continuous, and no point is without light.
class ProbeBlender {
  public:
    explicit ProbeBlender(const ProbeSet& set, const BlendOptions& options = {});

    /// normal: of unit length, on the side from which the surface is seen.
    ProbeBlend at(const Vec3f& point, const Vec3f& normal) const;

    /// The prefiltered radiance that arrives at the point from a direction, of unit length.
    Vec3f radiance(const ProbeBlend& blend, const Vec3f& point, const Vec3f& direction, float roughness) const;
    /// E / pi from the irradiance cubes, or from nine harmonics.
    Vec3f irradiance_over_pi(const ProbeBlend& blend, const Vec3f& normal) const;
    Vec3f irradiance_over_pi_sh(const ProbeBlend& blend, const Vec3f& normal) const;

    const ProbeSet& set() const { return *set_; }
    const BlendOptions& options() const { return options_; }

  private:
    struct Weighted;
    struct Nearest;
    Nearest nearest(const Vec3f& point) const;
    void add_grid_cell(Weighted& sum, const Vec3f& point, const Vec3f& normal) const;
    void add_tetrahedron(Weighted& sum, const Nearest& near, const Vec3f& point, const Vec3f& normal) const;
    void add_nearest(Weighted& sum, const Nearest& near, const Vec3f& point, const Vec3f& normal) const;
    /// The product of all factors but the interpolation weight.
    float importance(int probe, const Vec3f& point, const Vec3f& normal) const;

    const ProbeSet* set_;
    BlendOptions options_;
    Vec3f offset_;                          ///< metres, for a normal of 1 on each axis
    std::vector<int> usable_;               ///< the valid probes, or all if none is or validity does not count
    std::optional<Tetrahedra> tetrahedra_;  ///< between those, where there is no grid
};

}  // namespace domelight
