#pragma once

#include "domelight/filtering/prefilter.h"

#include <memory>

namespace domelight {

/// The exact prefilter for many cubes of one size, such as light probes that a renderer captures: what does not depend on the
/// light (quadrature, Legendre functions, kernels) is computed once, when the filter is made.
///
///     const auto filter = ProbeFilter::make(64, options);  // once
///     const auto levels = filter->filter(cube);            // for each probe: 3 to 4 ms for five levels of 64²
///
/// The filter is that of prefilter() with fewer degrees and a finer quadrature (docs/math/prefilter.md, "Probes"): the RMS
/// error is at most 3e-5 of the level's RMS value (faces of 64², five photographs with suns). Results do not depend on what
/// was filtered before, nor on the number of threads.
class ProbeFilter {
  public:
    /// size      of a face: 16 to 256
    /// options   `progress` is not called
    /// Errors: those of check_filter_options(); `size` outside its range.
    static Result<ProbeFilter> make(int size, const FilterOptions& options);

    ProbeFilter(ProbeFilter&&) noexcept;
    ProbeFilter& operator=(ProbeFilter&&) noexcept;
    ~ProbeFilter();

    int size() const;
    const FilterOptions& options() const;

    /// May be called from several threads at a time.
    ///
    /// cube   finite values of 0 and more
    /// Errors: `cube` is not of the filter's size.
    Result<FilterResult> filter(const Cubemap& cube) const;

  private:
    struct Prepared;
    explicit ProbeFilter(std::unique_ptr<const Prepared> prepared);
    std::unique_ptr<const Prepared> prepared_;
};

}  // namespace domelight
