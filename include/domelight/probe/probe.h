#pragma once
// A probe: a point of a scene at which the light that arrives from all directions was captured.

#include "domelight/base/vec.h"

#include <cstdint>
#include <optional>

namespace domelight {

/// An axis-aligned box in the world, metres; low <= high on every axis.
struct ProbeBox {
    Vec3f low, high;
};

/// Where a probe contributes to the shading of a scene.
struct ProbeInfluence {
    enum class Shape : std::uint8_t {
        everywhere,
        box,    ///< within `box`
        sphere  ///< within `radius` of the probe's position
    };
    Shape shape = Shape::everywhere;
    ProbeBox box{};
    float radius = 0;  ///< metres, > 0 for a sphere
    float fade = 0;    ///< metres inside the boundary over which the weight falls from 1 to 0, >= 0
};

struct Probe {
    Vec3f place{};     ///< where it was asked for
    Vec3f position{};  ///< where it captured light: moved away from surfaces that are too near
    /// Whether its light may be used. False where its place lies inside a body and no place outside was near enough.
    bool valid = true;
    bool moved = false;
    int filled_from = -1;  ///< of an invalid probe: the number of the valid probe whose light it was given; -1: none
    ProbeInfluence influence{};
    std::optional<ProbeBox> proxy{};  ///< stands for the walls around it in lookups that correct parallax
};

}  // namespace domelight
