#pragma once

#include "domelight/capture/capture.h"
#include "domelight/probe/probe_set.h"
#include "domelight/texture/texture.h"

#include <memory>
#include <vector>

namespace domelight {

struct ProbeBakerOptions {
    int size = 64;             ///< of a face of the capture and of level 0, 8 .. 1024
    int levels = 0;            ///< of the specular chain, 2 .. 16; 0: down to 4 x 4 texels
    int irradiance_size = 16;  ///< 1 .. 256
    /// Of a face of the distances: a whole part of `size`. 0: none; -1: the largest part that is at most 32.
    int distance_size = -1;
    /// Metres, > 0: farther surfaces, and directions in which there is none, count as this far.
    float farthest = 1000;
};

/// Errors: an option out of its range, or several that do not go together.
Result<void> check_baker_options(const ProbeBakerOptions& options);

/// Bytes of one probe's maps on disk. The options must be valid.
std::uint64_t probe_bytes(const ProbeBakerOptions& options, Encoding encoding);

/// The largest size, a power of two from 8 to 512, at which so many probes take at most `bytes` on disk. Errors: not even
/// the least does.
///
/// options   of which `size` is not read
Result<int> size_for_budget(const ProbeBakerOptions& options, Encoding encoding, std::uint64_t bytes, int probes);

/// Makes a probe's maps from what it captured: what all probes share is computed once.
///
/// Level 0 is the capture itself. The others are its exact prefilter (ProbeFilter, or prefilter() for sizes beyond its
/// range) with the generic engine's roughness, and so is the irradiance. The moments of the distance are averages over
/// the texels' area.
class ProbeBaker {
  public:
    /// Errors: an option out of its range.
    static Result<ProbeBaker> make(const ProbeBakerOptions& options);
    ~ProbeBaker();
    ProbeBaker(ProbeBaker&&) noexcept;
    ProbeBaker& operator=(ProbeBaker&&) noexcept;

    const ProbeBakerOptions& options() const;     ///< with the number of levels filled in
    const std::vector<float>& roughness() const;  ///< of each level
    /// The maps of a capture of the stated size. May be called from several threads at once.
    Result<ProbeMaps> operator()(const CapturedCube& captured) const;

  private:
    struct Impl;
    ProbeBaker();
    std::unique_ptr<Impl> impl_;
};

}  // namespace domelight
