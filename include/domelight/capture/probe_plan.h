#pragma once

#include "domelight/capture/placement.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// Where the probes of a scene are wanted: exactly one of `at`, `grid`, `density` and `auto_count` is set.
struct ProbePlanOptions {
    std::vector<Vec3f> at;             ///< places, metres
    std::array<int, 3> grid{0, 0, 0};  ///< a regular grid of so many places along X, Y and Z
    double density = 0;                ///< a regular grid of so many probes to the square metre (grid_over())
    int auto_count = 0;                ///< auto_places(), up to so many
    std::optional<ProbeBox> region;    ///< that grid, density and auto_count fill; none: the box around the scene
    /// Metres that a probe keeps from surfaces and may be moved by (RelocationOptions). 0 and -1: a twentieth and 0.45 of
    /// a grid's least spacing; 0.1 and 0.5 where there is none. Not read with auto_count, which goes by its cells.
    float nearest = 0, farthest = -1;

    bool walls = true;              ///< each probe gets the box of the walls around it as its proxy (room_around())
    std::optional<ProbeBox> proxy;  ///< or this one
    /// Of each probe. A box is its proxy, and fades over a tenth of its shortest side; a sphere has this radius, over a
    /// tenth of which it fades.
    ProbeInfluence::Shape influence = ProbeInfluence::Shape::everywhere;
    float radius = 0;

    int bounces = 2;  ///< auto_count: of the small captures by which the light is judged
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress = {};
};

struct ProbePlan {
    std::vector<Probe> probes;
    std::optional<ProbeGrid> grid;  ///< that they lie in, and in whose order they are
    std::string how;                ///< "grid", "density 2", "auto 100" or "at": for ProbeBakeOptions::placement
};

/// Places probes, moves them out of geometry (place_probes()), finds the light that invalid ones are given
/// (fill_invalid()), and sets their boxes. Errors: none or several ways of placing; those of grid_over(), place_probes(),
/// fill_invalid() and auto_places(); a radius that is not above 0.
Result<ProbePlan> plan_probes(const RayScene& scene, const EnvironmentSampler& light, const ProbePlanOptions& options);

}  // namespace domelight
