#include "domelight/filtering/prefilter.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/base/parallel.h"

#include "filtering/harmonic/bright_texels.h"
#include "filtering/harmonic/cube_analysis.h"
#include "filtering/filter_plan.h"
#include "filtering/kernel/residual_kernel.h"
#include "filtering/harmonic/sh_analysis.h"
#include "filtering/harmonic/sh_synthesis.h"
#include "filtering/harmonic/spectrum_evaluate.h"

#include <cmath>
#include <memory>

namespace domelight {
namespace {

/// Image rows that pass through at once: few enough to stay in cache from the reader to the last consumer.
constexpr int k_chunk_rows = 64;

const Error k_cancelled{"cancelled", "", ""};

std::vector<std::unique_ptr<AreaResampler>> make_mirrors(const FilterOptions& options, int width, int height) {
    std::vector<std::unique_ptr<AreaResampler>> mirrors(options.specular.size());
    for (std::size_t l = 0; l < mirrors.size(); ++l) {
        const LevelSpec& level = options.specular[l];
        if (!level.mirror) continue;
        mirrors[l] =
            options.layout == Layout::cube
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
        map.cube = Cubemap(std::move(image));
    }
    return map;
}

Vec3d mean_radiance(const Spectrum& spectrum) {
    const double y00 = 1 / std::sqrt(4 * k_pi);
    return Vec3d{spectrum.coefficient(0, 0, 0).real(), spectrum.coefficient(0, 0, 1).real(),
                 spectrum.coefficient(0, 0, 2).real()} *
           y00;
}

/// Makes the levels of a plan, group by group.
class Synthesis {
  public:
    /// The environment's brightest texels as point lights, fine enough for a band limit.
    using Bright = std::function<BrightPoints(int band_limit)>;

    /// `narrow`: the spectrum for narrow lobes, without what `split` holds; null where nothing was taken out.
    Synthesis(const Spectrum& spectrum, const Spectrum* narrow, const BrightSplit* split, Bright bright,
              const FilterOptions& options, FilterResult& result)
        : spectrum_(spectrum),
          narrow_(narrow),
          split_(split),
          bright_(std::move(bright)),
          options_(options),
          result_(result) {}

    Result<void> run(const FilterPlan& plan) {
        for (const FilterPlan::Group& group : plan.groups) {
            // A few at a time: a grid of many degrees is hundreds of megabytes.
            const std::size_t at_once = group.band_limit > 1200 ? 1 : 4;
            for (std::size_t from = 0; from < group.levels.size(); from += at_once) {
                const std::span levels(group.levels.data() + from, std::min(at_once, group.levels.size() - from));
                synthesise(group, levels);
                done_ += levels.size();
                if (options_.progress && !options_.progress("filter", double(done_) / (options_.specular.size() + 1)))
                    return k_cancelled;
            }
        }
        return {};
    }

  private:
    ZonalKernel kernel(int level) const {
        return level == FilterPlan::k_irradiance ? ZonalKernel::cosine() : options_.specular[level].kernel;
    }

    void synthesise(const FilterPlan::Group& group, std::span<const int> levels) {
        std::vector<ZonalKernel> kernels;
        bool residual = false;
        for (const int level : levels) {
            kernels.push_back(kernel(level));
            residual |= leaves_residual(kernels.back());
        }
        std::vector<std::vector<double>> factors(levels.size());
        parallel_for(int(levels.size()), options_.threads,
                     [&](int i) { factors[i] = kernels[i].coefficients(group.band_limit); });
        const bool split = group.narrow && narrow_;
        const auto grids = sh_synthesis(split ? *narrow_ : spectrum_, factors, group.grid, options_.threads);
        BrightPoints points;
        std::unique_ptr<ResidualKernels> tables;
        if (residual) {
            points = bright_(group.band_limit);
            if (points.count() > 0) tables = std::make_unique<ResidualKernels>(kernels, factors, options_.threads);
        }
        for (std::size_t i = 0; i < levels.size(); ++i) {
            LookupOptions lookup{double(group.band_limit) / group.grid.rings,
                                 options_.world_to_source,
                                 options_.threads,
                                 nullptr,
                                 {},
                                 nullptr,
                                 {}};
            if (tables && leaves_residual(kernels[i])) lookup.bright = &points, lookup.residual = tables->table(int(i));
            BrightSplit::Lights lights;
            const DirectKernelTable direct(kernels[i]);
            if (split) {
                lights = split_->lights(kernels[i]);
                lookup.lights = &lights, lookup.kernel = direct.view();
            }
            const bool irradiance = levels[i] == FilterPlan::k_irradiance;
            const int size = irradiance ? options_.irradiance_size : options_.specular[levels[i]].size;
            FilteredMap& map = irradiance ? result_.irradiance_over_pi : result_.specular[levels[i]];
            if (options_.layout == Layout::cube)
                map.cube = grid_to_cube(grids[i], size, lookup, result_.clamped);
            else
                map.latlong = grid_to_latlong(grids[i], size, lookup, result_.clamped);
        }
    }

    const Spectrum& spectrum_;
    const Spectrum* narrow_;
    const BrightSplit* split_;
    Bright bright_;
    const FilterOptions& options_;
    FilterResult& result_;
    std::size_t done_ = 0;
};

/// Everything that follows from the spectrum.
Result<void> finish(const Spectrum& spectrum, const Spectrum* narrow, const BrightSplit* split,
                    Synthesis::Bright bright, const FilterPlan& plan, const FilterOptions& options,
                    FilterResult& result) {
    result.band_limit = plan.band_limit;
    result.mean = mean_radiance(spectrum);
    if (auto done = Synthesis(spectrum, narrow, split, std::move(bright), options, result).run(plan); !done)
        return done;
    if (options.sh_bands > 0) result.sh = spectrum_to_sh(spectrum, options.sh_bands, options.world_to_source);
    return {};
}

}  // namespace

Result<FilterResult> prefilter(RowSource& source, const FilterOptions& options) {
    const int width = source.width(), height = source.height();
    const FilterPlan plan = make_filter_plan(options);
    ShAnalysis analysis(width, height, plan.band_limit, options.threads);
    BrightTexels bright(width, height);
    BrightSplit split(width, height);
    auto mirrors = make_mirrors(options, width, height);

    ImageF rows(width, std::min(k_chunk_rows, height), 3);
    std::vector<simd::Summary> summaries(k_chunk_rows);
    for (int y = 0; y < height; y += k_chunk_rows) {
        const auto chunk = rows.view().rows(0, std::min(k_chunk_rows, height - y));
        if (auto read = source.read(chunk); !read) return read.error();
        for (auto& mirror : mirrors)
            if (mirror) mirror->add_rows(chunk);
        parallel_ranges(chunk.height, 8, options.threads, [&](int begin, int end) {
            for (int k = begin; k < end; ++k) summaries[std::size_t(k)] = simd::summarize(chunk.row(k), 3 * width);
        });
        bright.add_rows(chunk, summaries);
        if (plan.split) split.take_from(chunk, summaries);
        analysis.add_rows(chunk);
        if (options.progress && !options.progress("read", double(y + chunk.height) / height)) return k_cancelled;
    }
    rows = {};

    FilterResult result;
    result.specular.resize(options.specular.size());
    for (std::size_t l = 0; l < mirrors.size(); ++l) {
        if (!mirrors[l]) continue;
        result.specular[l] = as_map(options.layout, mirrors[l]->finish());
        mirrors[l].reset();
    }
    const Spectrum spectrum = analysis.finish();
    const auto points = [&](int band_limit) { return bright.points(result.mean, band_limit); };
    Result<void> done;
    if (split.empty()) {
        done = finish(spectrum, nullptr, nullptr, points, plan, options, result);
    } else {
        Spectrum whole = split.spectrum(plan.wide_band_limit, options.threads);
        whole.add(spectrum);
        done = finish(whole, &spectrum, &split, points, plan, options, result);
    }
    if (!done) return done.error();
    return result;
}

Result<FilterResult> prefilter(const Cubemap& source, const FilterOptions& options) {
    const FilterPlan plan = make_filter_plan(options);
    FilterResult result;
    result.specular.resize(options.specular.size());
    for (std::size_t l = 0; l < options.specular.size(); ++l) {
        const LevelSpec& level = options.specular[l];
        if (!level.mirror) continue;
        FilteredMap& map = result.specular[l];
        if (options.layout == Layout::cube)
            map.cube = area_resample_cube(source, level.size, options.world_to_source, options.threads);
        else
            map.latlong = area_resample_cube_to_latlong(source, level.size, options.world_to_source, options.threads);
    }
    if (options.progress && !options.progress("read", 1)) return k_cancelled;
    const BorderedCube cube(source);
    const Spectrum spectrum = analyse_cube(cube, plan.band_limit, options.threads);
    const auto points = [&](int band_limit) { return bright_points(cube, result.mean, band_limit); };
    if (auto done = finish(spectrum, nullptr, nullptr, points, plan, options, result); !done) return done.error();
    return result;
}

}  // namespace domelight
