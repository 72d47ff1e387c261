#pragma once
// The cubes of a set on disk: specular.ktx2, irradiance.ktx2 and distance.ktx2.

#include "domelight/probe/probe_set.h"
#include "domelight/texture/texture.h"

#include "probe/probe_set_builder.h"
#include "texture/container/cube_array.h"

#include <optional>

namespace domelight {

struct ProbeMapFilePaths {
    std::filesystem::path specular, irradiance, distance;
};

/// Writes the maps of probes in any order.
class ProbeMapWriter {
  public:
    /// encoding   of specular and irradiance: rgb9e5, rgba16f or rgba32f
    static Result<ProbeMapWriter> open(const ProbeMapFilePaths& paths, int probes, const ProbeMapSizes& sizes,
                                       std::span<const float> roughness, Encoding encoding);

    /// May be called from several threads at once. Returns the number of texels that the encoding had to clip. Failures
    /// of writing are remembered: finish() returns the first.
    std::int64_t write(int probe, const ProbeMaps& maps);
    Result<void> finish();

  private:
    ProbeMapWriter(Encoding encoding, CubeArrayWriter specular, CubeArrayWriter irradiance,
                   std::optional<CubeArrayWriter> distance)
        : encoding_(encoding),
          specular_(std::move(specular)),
          irradiance_(std::move(irradiance)),
          distance_(std::move(distance)) {}

    Encoding encoding_;
    CubeArrayWriter specular_, irradiance_;
    std::optional<CubeArrayWriter> distance_;
};

}  // namespace domelight
