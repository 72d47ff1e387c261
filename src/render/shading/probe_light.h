#pragma once

#include "domelight/probe/probe_blend.h"
#include "domelight/render/shading/shading.h"

#include "render/surface/surface.h"

namespace domelight {

/// The light that the probes around a surface give it.
class ProbeLight final : public LightAt {
  public:
    ProbeLight(const ProbeBlender& probes, const SurfacePoint& s)
        : probes_(probes), point_(s.position), blend_(probes.at(s.position, s.normal)) {}

    Vec3f specular(const Vec3f& direction, float roughness) const override {
        return probes_.radiance(blend_, point_, direction, roughness);
    }
    /// Probes have a GGX chain: the lobe of the matching roughness.
    Vec3f phong(const Vec3f& direction, float exponent) const override;
    Vec3f irradiance_over_pi(const Vec3f& normal) const override { return probes_.irradiance_over_pi(blend_, normal); }
    Vec3f irradiance_over_pi_sh(const Vec3f& normal) const override {
        return probes_.irradiance_over_pi_sh(blend_, normal);
    }
    ScaleBias brdf(float NdotV, float roughness) const override;

  private:
    const ProbeBlender& probes_;
    Vec3f point_;
    ProbeBlend blend_;
};

}  // namespace domelight
