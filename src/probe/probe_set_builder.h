#pragma once
// Makes a ProbeSet probe by probe.

#include "domelight/probe/probe_set.h"

#include "probe/cube_store.h"

namespace domelight {

struct ProbeSet::Impl {
    ProbeSource scene, environment;
    std::vector<Probe> probes;
    std::optional<ProbeGrid> grid;
    std::vector<std::array<int, 4>> tetrahedra;
    std::vector<float> roughness;
    std::vector<CubeStore<PackedRgb>> specular;  ///< one for each level
    CubeStore<PackedRgb> irradiance_over_pi;
    CubeStore<PackedMoments> distance;
    std::vector<std::array<Vec3d, 9>> harmonics;             ///< of the radiance
    std::vector<std::array<Vec3d, 9>> harmonics_irradiance;  ///< of E / pi
};

/// Errors: a grid that is not one of so many probes; values of roughness that do not rise from 0.
Result<void> check_set(const std::optional<ProbeGrid>& grid, std::size_t probes, std::span<const float> roughness);

/// Texels along a face of each kind of map.
struct ProbeMapSizes {
    std::vector<int> specular;  ///< of each level
    int irradiance = 0;
    int distance = 0;  ///< 0: none
};

class ProbeSetBuilder {
  public:
    ProbeSetBuilder(std::vector<Probe> probes, std::optional<ProbeGrid> grid, std::vector<float> roughness,
                    const ProbeMapSizes& sizes);
    /// Maps of those sizes. To be called once for each probe; may be called for different ones at once.
    void set(int probe, const ProbeMaps& maps);
    void set_sources(ProbeSource scene, ProbeSource environment);
    ProbeSet take() { return std::move(set_); }

  private:
    ProbeSet set_;
};

}  // namespace domelight
