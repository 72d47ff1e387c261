#pragma once

#include "domelight/probe/probe.h"
#include "domelight/render/render.h"

#include <optional>
#include <span>

namespace domelight {

/// The box of the walls around a point, for the correction of parallax (Probe::proxy): on each of its six sides as far
/// away as the median of the surfaces that rays towards that side meet and that face along its axis, measured along the
/// axis. An open side, with few of them, is that of the scene's box, or at the point if that lies outside of the box.
/// None where fewer than three sides have walls.
std::optional<ProbeBox> room_around(const RayScene& scene, const Vec3f& point);

/// Sets Probe::proxy of every probe to room_around() its position.
void set_proxies(const RayScene& scene, std::span<Probe> probes, int threads = 0);

}  // namespace domelight
