#pragma once

#include "domelight/render/render.h"

#include "render/film.h"

#include <memory>
#include <span>

namespace domelight {

/// Adds samples to the pixels of a tile.
class TileTracer {
  public:
    virtual ~TileTracer() = default;
    /// Adds `count[i]` samples to pixel i of the tile that begins at (x0, y0) and is `columns` wide. Returns the number
    /// of rays traced.
    virtual std::int64_t trace(int x0, int y0, int columns, std::span<const int> count,
                               std::span<PixelSums> sums) const = 0;
};

/// The path tracer; its arguments must outlive it.
std::unique_ptr<TileTracer> make_path_tracer(const RayScene& scene, const EnvironmentSampler& sampler,
                                             const RenderOptions& options);

}  // namespace domelight
