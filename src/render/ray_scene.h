#pragma once
// A wrapper of Embree with a few functions.

#include "domelight/render/render.h"

#include "render/emitters.h"

#include <embree3/rtcore.h>

#include <span>

namespace domelight {

struct RayScene::Impl {
    Impl() = default;
    ~Impl();
    Scene scene;
    Emitters emitters;
    RTCDevice device = nullptr;
    RTCScene world = nullptr;
    std::vector<RTCScene> objects;  ///< of meshes that have several instances
    std::vector<int> instance_of;   ///< of a geometry of `world`
    std::size_t bytes = 0;

    Hit intersect(const Ray& ray, bool coherent) const;
    /// Whether anything lies on the ray, up to its far end.
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
