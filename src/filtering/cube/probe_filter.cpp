#include "domelight/filtering/probe_filter.h"

#include "base/field_place.h"
#include "base/large_memory.h"
#include "base/text.h"
#include "filtering/cube/cube_analysis.h"
#include "filtering/cube/cube_to_rings.h"
#include "filtering/filter_plan.h"
#include "filtering/harmonic/scatter_analysis.h"
#include "filtering/level_synthesis.h"

#include <algorithm>

namespace domelight {
namespace {

constexpr int k_least_size = 16, k_most_size = 256;

/// Fewer degrees than for large cubes: docs/math/prefilter.md, "Probes".
/// The texels of the smallest cubes have next to no light in the highest of them.
DegreeLimits probe_degrees(int size) {
    return size <= 32 ? DegreeLimits{48, 12} : DegreeLimits{64, 13};
}
/// A light of this part of the total power has a truncation error of 1e-5 of the level's RMS value.
constexpr double k_probe_least_share = 1e-3;
/// Of more such lights than this the strongest are taken. They are then the windows of a dark room, or a capture's
/// noise, whose truncation errors cancel: docs/math/prefilter.md, "Probes".
constexpr std::size_t k_probe_most_lights = 12;

/// Enough nodes along a texel's side that a function of this band limit is integrated over it; an even number.
int even_nodes_a_cell(int size, int band_limit) {
    const int nodes = std::clamp(2 + int(0.75 * band_limit / size), 2, 10);
    return nodes + nodes % 2;
}

FilterOptions without_progress(FilterOptions options) {
    options.progress = nullptr;
    return options;
}

std::vector<std::size_t> copied_levels(int size, const FilterOptions& options) {
    std::vector<std::size_t> copied;
    if (options.layout != Layout::cube || options.world_to_source != Mat3{}) return copied;
    for (std::size_t l = 0; l < options.specular.size(); ++l)
        if (options.specular[l].mirror && options.specular[l].size == size) copied.push_back(l);
    return copied;
}

/// The same, where these levels are not to be filled.
FilterOptions without_levels(FilterOptions options, const std::vector<std::size_t>& levels) {
    for (const std::size_t level : levels) options.specular[level].mirror = false;
    return options;
}

}  // namespace

struct ProbeFilter::Prepared {
    Prepared(int size_, const FilterOptions& options_)
        : size(size_),
          options(without_progress(options_)),
          copies(copied_levels(size, options)),
          others(without_levels(options, copies)),
          plan(make_filter_plan(options, false, probe_degrees(size))),
          levels(plan, options),
          analysis(levels.transform(plan.band_limit)),
          table(lookup_table(double(plan.band_limit) / analysis->grid.rings)),
          to_rings(size, analysis->grid, *table, even_nodes_a_cell(size, plan.band_limit)) {}

    int size;
    FilterOptions options;
    /// Levels that are the cube itself, texel by texel, and the options without those.
    std::vector<std::size_t> copies;
    FilterOptions others;
    FilterPlan plan;
    PreparedLevels levels;
    std::shared_ptr<const RingTransform> analysis;
    std::shared_ptr<const simd::TapTable> table;
    CubeToRings to_rings;
};

ProbeFilter::ProbeFilter(std::unique_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
ProbeFilter::ProbeFilter(ProbeFilter&&) noexcept = default;
ProbeFilter& ProbeFilter::operator=(ProbeFilter&&) noexcept = default;
ProbeFilter::~ProbeFilter() = default;

Result<ProbeFilter> ProbeFilter::make(int size, const FilterOptions& options) {
    if (size < k_least_size || size > k_most_size)
        return Error{text(size, " is not in ", k_least_size, " to ", k_most_size), field_place("size"), ""};
    if (auto ok = check_filter_options(options); !ok) return ok.error();
    return ProbeFilter(std::make_unique<const Prepared>(size, options));
}

int ProbeFilter::size() const {
    return prepared_->size;
}
const FilterOptions& ProbeFilter::options() const {
    return prepared_->options;
}

Result<FilterResult> ProbeFilter::filter(const Cubemap& source) const {
    const Prepared& p = *prepared_;
    if (source.size() != p.size)
        return Error{text("faces of ", source.size(), " texels, expected ", p.size), field_place("cube"), ""};
    const LargeMemoryReuse reuse;
    FilterResult result;
    result.specular.resize(p.options.specular.size());
    fill_mirror_levels(source, p.others, result);
    for (const std::size_t level : p.copies) result.specular[level] = source;
    const BorderedCube cube(source);
    ScatterAnalysis analysis(p.analysis);
    std::vector<SphereGrid> grids;
    grids.emplace_back(p.analysis->grid);
    p.to_rings.apply(cube, grids[0], p.options.threads);
    SynthesisSource from;
    from.whole = analysis.finish(grids, p.options.threads);
    result.mean = mean_radiance(from.whole);
    result.band_limit = p.plan.band_limit;
    from.bright = [&](int band_limit) {
        return bright_points(cube, result.mean, band_limit, k_probe_least_share, k_probe_most_lights);
    };
    if (auto done = make_levels(from, p.plan, p.options, result, &p.levels); !done) return done.error();
    return result;
}

}  // namespace domelight
