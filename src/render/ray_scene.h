#pragma once
// A wrapper of Embree with a few functions.

#include "domelight/render/render.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <span>

namespace domelight {

/// The point where a ray hit a surface.
struct Hit {
    float distance = 0;
    int instance = -1;  ///< -1: none
    int triangle = 0;
    float u = 0, v = 0;      ///< barycentric: (1 - u - v) a + u b + v c
    Vec3f geometric_normal;  ///< in the world, not of unit length, towards the front
};

struct Ray {
    Vec3f origin, direction;
    float near = 0;
};

/// Continues a ray behind the surface that it hit.
inline void pass(Ray& ray, const Hit& hit) {
    ray.near = std::nextafter(hit.distance + 4e-6f * (1 + hit.distance), 1e30f);
}

struct RayScene::Impl {
    Impl() = default;
    ~Impl();
    Scene scene;
    RTCDevice device = nullptr;
    RTCScene world = nullptr;
    std::vector<RTCScene> objects;  ///< of meshes that have several instances
    std::vector<int> instance_of;   ///< of a geometry of `world`
    std::size_t bytes = 0;

    Hit intersect(const Ray& ray, bool coherent) const;
    /// Whether anything lies on the ray.
    bool occluded(const Ray& ray) const;

    /// Traces up to k_packet rays of similar directions together, which is several times as fast for camera rays.
    static constexpr int k_packet = 16;
    void intersect(std::span<const Ray* const> rays, std::span<Hit> hits) const;
    /// Bit i: whether ray i is occluded.
    std::uint32_t occluded(std::span<const Ray* const> rays) const;

  private:
    Hit hit_of(unsigned geometry, unsigned instance_id, unsigned triangle, float distance, float u, float v,
               const Vec3f& normal) const;
};

}  // namespace domelight
