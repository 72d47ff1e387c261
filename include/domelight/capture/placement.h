#pragma once
// Where probes are placed.

#include "domelight/base/progress.h"
#include "domelight/probe/probe.h"
#include "domelight/probe/probe_grid.h"
#include "domelight/render/render.h"

#include <span>
#include <vector>

namespace domelight {

/// How dense a grid is.
struct GridOptions {
    /// Probes for a square metre, > 0: neighbours are at most 1 / sqrt(density) metres apart on every axis.
    double density = 1;
    int most = 4096;  ///< probes, 1 .. 2^20; a grid of more is an error that names a density that would do
};
/// A grid that fills a box, its outermost places half a spacing from the sides. Errors: a density that is not a number
/// above 0; more probes than `most`; a box that has no extent on any axis or is not finite.
Result<ProbeGrid> grid_over(const ProbeBox& box, const GridOptions& options);
/// The same with stated numbers of places, each 1 .. 4096. An axis on which the box has no extent must have one place.
Result<ProbeGrid> grid_over(const ProbeBox& box, int nx, int ny, int nz);

struct RelocationOptions {
    float nearest = 0.1f;   ///< metres that a probe keeps from surfaces, > 0
    float farthest = 0.5f;  ///< metres by which it may be moved, >= 0
    int rays = 256;         ///< in all directions from each place, 16 .. 65536
    /// The environment, which must outlive the call. Where it is set, a place inside a body of double-sided surfaces is
    /// noticed, too: all rays meet surfaces, more than a quarter of them the side from which the corners run clockwise,
    /// and no light arrives.
    const EnvironmentSampler* light = nullptr;
    int threads = 0;
    Progress progress = {};
};

/// Makes probes of places, and moves them out of geometry as Majercik et al. 2019 and 2021 do ("Dynamic diffuse global
/// illumination with ray-traced irradiance fields", "Scaling probe-based real-time dynamic global illumination for
/// production"): where more than a quarter of the rays meet backs of surfaces, the place lies inside a body and the
/// probe is moved through one of the surfaces around to where the fewest rays meet backs; where a front is nearer than `nearest`, it is moved away from it. A place
/// inside a body from which no way out was found stays and is not valid. Surfaces that are double-sided have no back, unless `light` is set.
///
/// Errors: an option out of its range; a place that is not finite (it is named); "cancelled".
Result<std::vector<Probe>> place_probes(const RayScene& scene, std::span<const Vec3f> places,
                                        const RelocationOptions& options = {});

struct AutoPlacementOptions {
    int count = 100;  ///< the most probes, 8 .. 2^20
    ProbeBox region;  ///< in which they are placed: an extent on every axis
    int bounces = 2;  ///< of the small captures by which the light is judged
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress = {};
};

/// Places more probes where the light changes more. The region is divided into about cubic cells with a place at each
/// corner. Then, again and again, the cell whose corners' light differs most is divided into eight, until there are
/// `count` probes; the light of a place is judged by a small capture, as the irradiance from six sides. Places are moved
/// out of geometry as by place_probes(), with distances in proportion to their cell. Those inside bodies are left out,
/// so all probes are valid.
///
/// Errors: an option out of its range; no place lies in the open; "cancelled".
Result<std::vector<Probe>> auto_places(const RayScene& scene, const EnvironmentSampler& light,
                                       const AutoPlacementOptions& options);

/// All places of a grid, in its order.
std::vector<Vec3f> places_of(const ProbeGrid& grid);

/// Finds for each invalid probe the valid one whose light it is to be given: the one with the fewest surfaces between,
/// which keeps light from the other side of a wall away, and the nearest of these. Errors: no probe is valid.
Result<void> fill_invalid(const RayScene& scene, std::span<Probe> probes, int threads = 0);

}  // namespace domelight
