#pragma once
// The exact filter of an audit's source, at any sizes and roughnesses.

#include "domelight/base/progress.h"
#include "domelight/compare/bake_audit.h"

#include <functional>

namespace domelight {

struct ExactLevel {
    int size = 0;
    double roughness = 0;  ///< 0: the environment itself, averaged over texels
};

class ExactFilter {
  public:
    ExactFilter(const Environment& source, Lobe lobe, Texels texels, int threads)
        : source_(source), lobe_(lobe), texels_(texels), threads_(threads) {}

    /// Filters the source once for all levels (several times where they need more than 512 MiB together) and calls
    /// `use(index, cube)` for each, in order. `progress` is passed on to prefilter().
    Result<void> make(std::span<const ExactLevel> levels, const Progress& progress,
                      const std::function<void(std::size_t, Cubemap)>& use) const;

  private:
    Result<FilterResult> filter(std::span<const ExactLevel> levels, const Progress& progress) const;

    const Environment& source_;
    Lobe lobe_;
    Texels texels_;
    int threads_;
};

/// The callback for one run of prefilter() that is the part from `begin` to `end` of an audit, both in [0, 1].
Progress piece_of(const Progress& whole, double begin, double end);

}  // namespace domelight
