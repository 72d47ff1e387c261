#include "domelight/prefilter.h"

#include <cmath>
#include <memory>

#include "domelight/area_resample.h"
#include "filtering/filter_plan.h"
#include "filtering/sh_analysis.h"
#include "filtering/sh_synthesis.h"
#include "filtering/spectrum_evaluate.h"

namespace domelight {
namespace {

/// Image rows that pass through at once: few enough to stay in cache from the reader to the last consumer.
constexpr int k_chunk_rows = 64;

const Error k_cancelled{"cancelled", "", ""};

/// Tells how far the work is, from weights of its stages.
struct Steps {
    const Progress& progress;
    bool at(const char* stage, double done) const { return !progress || progress(stage, done); }
};

std::vector<std::unique_ptr<AreaResampler>> make_mirrors(const FilterOptions& options, int width, int height) {
    std::vector<std::unique_ptr<AreaResampler>> mirrors(options.specular.size());
    for (std::size_t l = 0; l < mirrors.size(); ++l) {
        const LevelSpec& level = options.specular[l];
        if (!level.mirror) continue;
        mirrors[l] = options.layout == Layout::cube
                         ? area_resample_to_cube(width, height, level.size, options.world_to_source, options.threads)
                         : area_resample_to_latlong(width, height, level.size, options.world_to_source, options.threads);
    }
    return mirrors;
}

FilteredMap as_map(Layout layout, ImageF image) {
    FilteredMap map;
    if (layout == Layout::latlong) {
        map.latlong = std::move(image);
    } else {
        map.cube = Cubemap(image.width());
        std::copy(image.pixels().begin(), image.pixels().end(), map.cube.pixels().begin());
    }
    return map;
}

/// Synthesises every level from the spectrum.
Result<void> synthesise(const Spectrum& spectrum, const FilterPlan& plan, const FilterOptions& options, FilterResult& result) {
    const Steps steps{options.progress};
    int done = 0;
    for (const FilterPlan::Group& group : plan.groups) {
        // A few at a time: a grid of many degrees is hundreds of megabytes.
        const int at_once = group.band_limit > 1200 ? 1 : 4;
        for (std::size_t from = 0; from < group.levels.size(); from += at_once) {
            const std::size_t count = std::min<std::size_t>(at_once, group.levels.size() - from);
            std::vector<std::vector<double>> factors;
            for (std::size_t i = from; i < from + count; ++i) {
                const int l = group.levels[i];
                factors.push_back((l == FilterPlan::k_irradiance ? ZonalKernel::cosine() : options.specular[l].kernel).coefficients(group.band_limit));
            }
            const auto grids = sh_synthesis(spectrum, factors, group.grid, options.threads);
            const double band = double(group.band_limit) / group.grid.rings;
            for (std::size_t i = 0; i < count; ++i) {
                const int l = group.levels[from + i];
                const int size = l == FilterPlan::k_irradiance ? options.irradiance_size : options.specular[l].size;
                FilteredMap& map = l == FilterPlan::k_irradiance ? result.irradiance_over_pi : result.specular[l];
                if (options.layout == Layout::cube)
                    map.cube = grid_to_cube(grids[i], band, size, options.world_to_source, options.threads, result.clamped);
                else
                    map.latlong = grid_to_latlong(grids[i], band, size, options.world_to_source, options.threads, result.clamped);
                ++done;
                if (!steps.at("filter", double(done) / (options.specular.size() + 1))) return k_cancelled;
            }
        }
    }
    return {};
}

}  // namespace

Result<FilterResult> prefilter(RowSource& source, const FilterOptions& options) {
    const int width = source.width(), height = source.height();
    const FilterPlan plan = make_filter_plan(options);
    const Steps steps{options.progress};
    ShAnalysis analysis(width, height, plan.band_limit, options.threads);
    auto mirrors = make_mirrors(options, width, height);

    ImageF rows(width, std::min(k_chunk_rows, height), 3);
    for (int y = 0; y < height; y += k_chunk_rows) {
        const auto chunk = rows.view().rows(0, std::min(k_chunk_rows, height - y));
        if (auto read = source.read(chunk); !read) return read.error();
        analysis.add_rows(chunk);
        for (auto& mirror : mirrors)
            if (mirror) mirror->add_rows(chunk);
        if (!steps.at("read", double(y + chunk.height) / height)) return k_cancelled;
    }
    rows = {};

    FilterResult result;
    result.specular.resize(options.specular.size());
    result.band_limit = plan.band_limit;
    for (std::size_t l = 0; l < mirrors.size(); ++l) {
        if (!mirrors[l]) continue;
        result.specular[l] = as_map(options.layout, mirrors[l]->finish());
        mirrors[l].reset();
    }
    const Spectrum spectrum = analysis.finish();
    if (auto done = synthesise(spectrum, plan, options, result); !done) return done.error();
    if (options.sh_bands > 0) result.sh = spectrum_to_sh(spectrum, options.sh_bands, options.world_to_source);
    for (int c = 0; c < 3; ++c) (c == 0 ? result.mean.x : c == 1 ? result.mean.y : result.mean.z) = spectrum.coefficient(0, 0, c).real() / std::sqrt(4 * k_pi);
    return result;
}

}  // namespace domelight
