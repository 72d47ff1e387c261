#pragma once
// The paths that a path tracer is tracing, and the working memory for a batch of them.

#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include "render/film.h"
#include "render/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {

constexpr int k_path_batch = 256;  ///< the number of samples that are traced together

inline float largest(const Vec3f& c) {
    return std::max({c.x, c.y, c.z});
}

/// The state that paths need only in scenes with layered materials.
struct PathLayers {
    LayeredBsdf bsdf;     ///< of the surface, if it has any
    bool inside = false;  ///< of a body
    LayeredBsdf body;     ///< the surface through which it was entered
};

/// The path of one sample of a pixel.
struct Path {
    int pixel = 0;            ///< in the tile
    std::uint32_t index = 0;  ///< of the pixel's samples
    std::uint64_t key = 0;    ///< of the pixel
    Ray ray;
    Vec3f throughput{1, 1, 1};
    float pdf_brdf = 0;         ///< of the ray's direction; 0: a camera ray
    bool drew_emitter = false;  ///< where the ray starts, a point was drawn from the surfaces that emit light
    Hit hit;
    SurfacePoint surface;
    Vec3f V;                       ///< local
    PathLayers* layers = nullptr;  ///< null in scenes without layered materials
    int passages = 0;              ///< refractions, and reflections inside bodies, which do not count as bounces
    bool passing = false;          ///< the ray has crossed a boundary; this is not counted as a bounce
    /// The share of the first surface's diffuse lobe in the light that arrives along the path.
    Vec3f diffuse_share;

    Vec3f radiance, direct, indirect, diffuse, specular;
    Vec3f albedo, normal;
    float depth = 0;
    int object = 0;
    bool covered = false;

    UnitPoint point(int pair) const { return sobol_owen(derive_key(key, std::uint64_t(pair)), index); }
    /// Adds light that arrives after `bounce` bounces to the layers of the picture.
    void add(const Vec3f& light, int bounce) {
        radiance += light;
        const bool first = bounce <= passages;
        (first ? direct : indirect) = (first ? direct : indirect) + light;
        const Vec3f below = product(light, diffuse_share);
        diffuse += below;
        specular += (light - below);
    }
    /// The same for light by lobe of the surface that it reaches; the lobes matter only at the first surface.
    void add(const Vec3f& d, const Vec3f& s, int bounce) {
        if (bounce > 0) return add(d + s, bounce);
        radiance = radiance + d + s;
        direct = direct + d + s;
        diffuse += d;
        specular += s;
    }
};

/// The pairs of dimensions of a path.
inline constexpr int k_pixel_pair = 0, k_pairs_a_bounce = 3;
constexpr int light_pair(int bounce) {
    return 1 + k_pairs_a_bounce * bounce;
}
constexpr int brdf_pair(int bounce) {
    return 2 + k_pairs_a_bounce * bounce;
}
constexpr int chance_pair(int bounce) {
    return 3 + k_pairs_a_bounce * bounce;
}

/// Numbers beyond those for bounces, for features that few surfaces have.
constexpr int shift_pair(int bounce) {
    return (1 << 20) + bounce;
}
constexpr int emitter_pair(int bounce) {
    return (1 << 21) + bounce;
}

/// Light that arrives at a path's surface unless it is occluded.
struct Shadow {
    Path* path;
    Ray ray;
    Vec3f diffuse, specular;  ///< the part of it that belongs to the first surface's lobes
};

/// A path whose last ray can only reach the environment.
struct Ending {
    Path* path;
    Vec3f direction;
};

/// The light samples of a batch.
struct LightBatch {
    LightBatch() : values(9 * k_path_batch), points(k_path_batch) {}
    LightSampleSpans spans(int n) {
        const auto part = [&](int k) { return std::span<float>(values.data() + k * k_path_batch, std::size_t(n)); };
        return {part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7), part(8)};
    }
    Vec3f direction(int i) const {
        return {values[2 * k_path_batch + i], values[3 * k_path_batch + i], values[4 * k_path_batch + i]};
    }
    Vec3f radiance(int i) const {
        return {values[5 * k_path_batch + i], values[6 * k_path_batch + i], values[7 * k_path_batch + i]};
    }
    float pdf(int i) const { return values[8 * k_path_batch + i]; }
    std::vector<float> values;
    std::vector<UnitPoint> points;
};

/// The working memory of a tile.
struct Workspace {
    Workspace() : hits(k_path_batch) { paths.reserve(k_path_batch); }
    std::vector<Path> paths;
    LightBatch light;  ///< drawn, or looked up
    std::vector<Shadow> shadows;
    std::vector<Ending> endings;
    std::vector<Hit> hits;
};

}  // namespace domelight
