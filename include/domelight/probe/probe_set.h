#pragma once
// The light of many probes, and how it is looked up.
//
//     auto set = ProbeSet::load("probes");
//     Vec3f light = set->radiance(0, {0, 1, 0}, 0.3f);

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/probe/probe.h"
#include "domelight/probe/probe_grid.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// How far the surfaces around a probe are: over the area of a texel. Lookups between texels follow walls
/// (src/probe/distance_lookup.h), which a wider lobe would blur: a point just behind a wall would be taken for lit.
struct DistanceMoments {
    float mean = 0;         ///< metres
    float mean_square = 0;  ///< square metres
};

/// The maps of one probe, in the world's axes.
struct ProbeMaps {
    /// RGB radiance prefiltered for GGX: level l has half the size of level l - 1, and level 0 is the light itself.
    std::vector<Cubemap> specular;
    Cubemap irradiance_over_pi;  ///< RGB
    /// Coefficients of the radiance, nine, in the basis of sh_basis().
    std::array<Vec3d, 9> harmonics{};
    /// Two channels: the moments of DistanceMoments. Empty: there are no surfaces, and distance() is infinite.
    Cubemap distance;
};

/// What a set was captured from.
struct ProbeSource {
    std::string file;    ///< without its folder; empty where there is none: the built-in sky, a set in memory
    std::string sha256;  ///< of a scene: scene_sha256(); of an environment: environment_sha256(). May be empty
};

/// Probes and their light. Texels of light are kept as RGB9E5 (docs/encodings.md), at a relative precision of 1/512 of a
/// texel's largest channel: 150 KB for a probe of 64 x 64 texels a face. Reading is safe from several threads at once.
class ProbeSet {
  public:
    /// Reads what `domelight probes -o FOLDER` wrote: probes.json and the files that it names (docs/probes.md). Errors
    /// name the file: not there, damaged, or not what probes.json says of it.
    static Result<ProbeSet> load(const std::filesystem::path& folder);
    /// A set in memory.
    ///
    /// grid        where its places are; `probes` are then in its order
    /// roughness   of each specular level: rising, from 0 to at most 1
    /// maps        one for each probe, all of the same sizes
    ///
    /// Errors: no probes; a number of probes, maps or levels that do not go together; maps of different sizes; a grid
    /// with a spacing that is not above 0.
    static Result<ProbeSet> from_maps(std::vector<Probe> probes, std::optional<ProbeGrid> grid,
                                      std::vector<float> roughness, std::span<const ProbeMaps> maps);
    ~ProbeSet();
    ProbeSet(ProbeSet&&) noexcept;
    ProbeSet& operator=(ProbeSet&&) noexcept;

    const ProbeSource& scene() const;
    const ProbeSource& environment() const;
    std::span<const Probe> probes() const;
    const std::optional<ProbeGrid>& grid() const;
    /// Where there is no grid: the tetrahedra between the probes, as four of their numbers each. Empty with a grid, and
    /// where the probes span no volume.
    std::span<const std::array<int, 4>> tetrahedra() const;
    void set_tetrahedra(std::vector<std::array<int, 4>> tetrahedra);

    std::span<const float> roughness() const;  ///< of the specular levels
    int specular_size() const;                 ///< of a face of level 0
    int irradiance_size() const;
    int distance_size() const;  ///< 0: there are no distances
    std::size_t memory_bytes() const;

    // Lookups take the number of a probe, and a world direction of any length but 0. They interpolate between texels,
    // without seams at the edges of faces.

    /// The prefiltered radiance. Between levels of roughness above 0 it is linear in the logarithm of the roughness, and
    /// between level 0 and level 1 linear in the roughness, as shaders of the generic engine read it.
    Vec3f radiance(int probe, const Vec3f& direction, float roughness) const;
    Vec3f irradiance_over_pi(int probe, const Vec3f& normal) const;
    /// The same from nine harmonics; values below 0 become 0.
    Vec3f irradiance_over_pi_sh(int probe, const Vec3f& normal) const;
    /// The texels of a specular level, RGB.
    Cubemap specular(int probe, int level) const;
    std::span<const Vec3d, 9> harmonics(int probe) const;  ///< of the radiance
    DistanceMoments distance(int probe, const Vec3f& direction) const;

  private:
    friend class ProbeSetBuilder;
    struct Impl;
    ProbeSet();
    std::unique_ptr<Impl> impl_;
};

}  // namespace domelight
