#include "domelight/base/parallel.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projection.h"

#include "base/large_memory.h"
#include "filtering/direct/direct_sums.h"
#include "filtering/filter_plan.h"
#include "filtering/harmonic/bright_texels.h"
#include "filtering/harmonic/cube_analysis.h"
#include "filtering/harmonic/scatter_analysis.h"
#include "filtering/harmonic/sh_analysis.h"
#include "filtering/harmonic/sh_synthesis.h"
#include "filtering/harmonic/spectrum_evaluate.h"
#include "filtering/kernel/residual_kernel.h"
#include "filtering/lights/light_groups.h"
#include "filtering/prefilter_runs.h"
#include "filtering/read_texels.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>

namespace domelight {
namespace {

/// The number of image rows processed together: few enough to stay in the cache from the reader to the last step.
constexpr int k_chunk_rows = 64;

const Error k_cancelled{"cancelled", "", ""};

/// The levels that are the environment itself, made while its rows pass by. Runs that want the same level share it.
class MirrorLevels {
  public:
    MirrorLevels(int width, int height, std::span<const FilterOptions> runs) {
        for (const FilterOptions& run : runs) {
            auto& mirrors = of_run_.emplace_back();
            for (const LevelSpec& level : run.specular)
                mirrors.push_back(level.mirror ? find_or_make(width, height, run, level.size) : -1);
        }
    }

    void add_rows(ImageView<const float> rows) {
        for (Mirror& mirror : mirrors_) mirror.resampler->add_rows(rows);
    }

    /// After the last row: fills the mirror levels of each run's result.
    void finish(std::span<FilterResult> results) {
        for (Mirror& mirror : mirrors_) {
            mirror.map = {mirror.layout, mirror.resampler->finish()};
            mirror.resampler.reset();
        }
        for (std::size_t r = 0; r < results.size(); ++r)
            for (std::size_t l = 0; l < of_run_[r].size(); ++l) {
                if (of_run_[r][l] < 0) continue;
                Mirror& mirror = mirrors_[std::size_t(of_run_[r][l])];
                results[r].specular[l] = --mirror.users ? mirror.map : std::move(mirror.map);
            }
    }

  private:
    struct Mirror {
        Layout layout;
        int size;
        Mat3 world_to_source;
        int users;
        std::unique_ptr<AreaResampler> resampler;
        FilteredMap map;
    };

    int find_or_make(int width, int height, const FilterOptions& run, int size) {
        const Mat3& turn = run.world_to_source;
        for (std::size_t i = 0; i < mirrors_.size(); ++i) {
            Mirror& m = mirrors_[i];
            if (m.layout != run.layout || m.size != size || m.world_to_source != turn) continue;
            ++m.users;
            return int(i);
        }
        auto resampler = run.layout == Layout::cube ? area_resample_to_cube(width, height, size, turn, run.threads)
                                                    : area_resample_to_latlong(width, height, size, turn, run.threads);
        mirrors_.push_back({run.layout, size, turn, 1, std::move(resampler), {}});
        return int(mirrors_.size()) - 1;
    }

    std::vector<Mirror> mirrors_;
    std::vector<std::vector<int>> of_run_;  ///< for each level of each run an index of mirrors_, or -1
};

Vec3d mean_radiance(const Spectrum& spectrum) {
    const double y00 = 1 / std::sqrt(4 * k_pi);
    return Vec3d{spectrum.coefficient(0, 0, 0).real(), spectrum.coefficient(0, 0, 1).real(),
                 spectrum.coefficient(0, 0, 2).real()} *
           y00;
}

/// Of each channel, the least value of a level, but not below a hundredth of the mean: an error is judged against this.
Vec3d least_values(const SphereGrid& grid, const Vec3d& mean) {
    simd::Texel least{1e30f, 1e30f, 1e30f};
    for (int k = 0; k < grid.grid().rings; ++k) least = simd::least(grid.ring(k), grid.grid().width, least);
    return {std::max(double(least.r), 0.01 * mean.x), std::max(double(least.g), 0.01 * mean.y),
            std::max(double(least.b), 0.01 * mean.z)};
}

/// What the levels are made of.
struct SynthesisSource {
    /// The environment's brightest texels as point lights, fine enough for a band limit.
    using Bright = std::function<PointLights(int band_limit)>;

    Spectrum whole;
    Bright bright;
    /// If texels were removed for narrow lobes: the texels, and the spectrum without them.
    const BrightSplit* split = nullptr;
    Spectrum rest = {};
};

/// Makes the levels of a plan, group by group.
class Synthesis {
  public:
    Synthesis(const SynthesisSource& source, const FilterPlan& plan, const FilterOptions& options, FilterResult& result)
        : source_(source), options_(options), result_(result) {
        prepare_lights(plan);
    }

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
    /// The lights of all levels that leave a residual, and their coefficients.
    void prepare_lights(const FilterPlan& plan) {
        int band_limit = 0;
        for (const FilterPlan::Group& group : plan.groups)
            for (const int level : group.levels)
                if (leaves_residual(kernel(level))) band_limit = std::max(band_limit, group.band_limit);
        if (band_limit == 0) return;
        const PointLights points = source_.bright(band_limit);
        if (points.count() == 0) return;
        lights_ = LightGroups(points);
        lights_spectrum_ = analyse_lights(points, band_limit, options_.threads);
    }

    ZonalKernel kernel(int level) const {
        return level == FilterPlan::k_irradiance ? ZonalKernel::cosine() : options_.specular[level].kernel;
    }

    void synthesise(const FilterPlan::Group& group, std::span<const int> levels) {
        // Levels with the same kernel share a grid: the last one of most chains is the irradiance.
        std::vector<ZonalKernel> kernels;
        std::vector<std::size_t> kernel_of;
        for (const int level : levels) {
            const ZonalKernel of_level = kernel(level);
            const auto found = std::find(kernels.begin(), kernels.end(), of_level);
            kernel_of.push_back(std::size_t(found - kernels.begin()));
            if (found == kernels.end()) kernels.push_back(of_level);
        }
        std::vector<SynthesisFactors> factors(kernels.size());
        std::vector<std::unique_ptr<ResidualKernel>> residuals(kernels.size());
        parallel_for(int(kernels.size()), options_.threads, [&](int i) {
            factors[i].k = kernels[i].coefficients(group.band_limit);
            if (lights_.empty() || !leaves_residual(kernels[i])) return;
            residuals[i] = std::make_unique<ResidualKernel>(kernels[i], factors[i].k);
            factors[i].r = residuals[i]->removed();
        });
        const bool split = group.narrow && source_.split;
        const auto grids = sh_synthesis(split ? source_.rest : source_.whole, &lights_spectrum_, factors, group.grid,
                                        options_.threads);
        for (std::size_t i = 0; i < kernels.size(); ++i) {
            LookupOptions lookup;
            lookup.band = double(group.band_limit) / group.grid.rings;
            lookup.world_to_source = options_.world_to_source;
            lookup.threads = options_.threads;
            std::optional<ResidualLights> residual;
            if (residuals[i]) {
                residual.emplace(lights_, *residuals[i], least_values(grids[i], result_.mean));
                lookup.residual = &*residual;
            }
            BrightSplit::Lights lights;
            std::optional<DirectKernelTable> direct;
            if (split) {
                lights = source_.split->lights(kernels[i]);
                direct.emplace(kernels[i]);
                lookup.lights = &lights, lookup.kernel = direct->view();
            }
            for (std::size_t l = 0; l < levels.size(); ++l)
                if (kernel_of[l] == i) look_up(levels[l], kernels[i], grids[i], lookup);
        }
    }

    void look_up(int level, const ZonalKernel& kernel, const SphereGrid& grid, const LookupOptions& lookup) {
        const bool irradiance = level == FilterPlan::k_irradiance;
        const int size = irradiance ? options_.irradiance_size : options_.specular[level].size;
        FilteredMap& map = irradiance ? result_.irradiance_over_pi : result_.specular[level];
        const bool for_reading = options_.texels == Texels::read && options_.layout == Layout::cube && !irradiance &&
                                 gains_by_read_texels(kernel, size);
        if (!options_.directions.empty())
            map = {Layout::latlong, grid_at_directions(grid, options_.directions, lookup, result_.clamped)};
        else if (for_reading)
            map = read_texels(grid_to_cube(grid, size * read_texels_factor(size), lookup, result_.clamped), size,
                              options_.threads);
        else if (options_.layout == Layout::cube)
            map = grid_to_cube(grid, size, lookup, result_.clamped);
        else
            map = {Layout::latlong, grid_to_latlong(grid, size, lookup, result_.clamped)};
    }

    const SynthesisSource& source_;
    const FilterOptions& options_;
    FilterResult& result_;
    LightGroups lights_;
    Spectrum lights_spectrum_;
    std::size_t done_ = 0;
};

/// Everything that follows from the spectrum.
Result<void> make_levels(const SynthesisSource& source, const FilterPlan& plan, const FilterOptions& options,
                         FilterResult& result) {
    if (auto done = Synthesis(source, plan, options, result).run(plan); !done) return done;
    if (options.sh_bands > 0) result.sh = spectrum_to_sh(source.whole, options.sh_bands, options.world_to_source);
    return {};
}

/// One filter run over the rows of a lat-long image, but for its mirror levels.
class RowPrefilter {
  public:
    RowPrefilter(int width, int height, const FilterOptions& options)
        : options_(options),
          plan_(make_filter_plan(options, options.directions.empty())),
          analysis_(width, height, plan_.band_limit, options.threads),
          bright_(width, height),
          split_(width, height) {
        if (!plan_.direct.empty()) sums_.emplace(width, height, options, plan_.direct);
    }

    /// Whether add_rows() sets texels of the rows to 0.
    bool changes_rows() const { return plan_.split; }

    /// The next rows, with simd::summarize of each.
    void add_rows(ImageView<float> rows, std::span<const simd::Summary> summaries) {
        bright_.add_rows(rows, summaries);
        if (plan_.split) split_.take_from(rows, summaries);
        if (sums_) sums_->add_rows(rows);
        analysis_.add_rows(rows);
    }

    /// After the last row.
    Result<void> finish(FilterResult& result) {
        if (sums_) {
            std::vector<FilteredMap> maps = sums_->finish(split_);
            for (std::size_t i = 0; i < maps.size(); ++i)
                result.specular[std::size_t(plan_.direct[i])] = std::move(maps[i]);
            sums_.reset();
        }
        Spectrum spectrum = analysis_.finish();
        SynthesisSource source;
        if (split_.empty()) {
            source.whole = std::move(spectrum);
        } else {
            source.split = &split_;
            source.whole = split_.spectrum(plan_.wide_band_limit, options_.threads);
            source.whole.add(spectrum);
            source.rest = std::move(spectrum);
        }
        result.mean = mean_radiance(source.whole);
        result.band_limit = plan_.band_limit;
        source.bright = [&](int band_limit) { return bright_.points(result.mean, band_limit); };
        return make_levels(source, plan_, options_, result);
    }

  private:
    FilterOptions options_;
    FilterPlan plan_;
    ShAnalysis analysis_;
    BrightTexels bright_;
    BrightSplit split_;
    std::optional<DirectSums> sums_;
};

/// The options of run `i` of `count`, whose progress goes on from where the run before it ended.
FilterOptions with_shared_progress(const FilterOptions& options, std::size_t i, std::size_t count) {
    FilterOptions shared = options;
    if (options.progress && count > 1)
        shared.progress = [progress = options.progress, i, count](std::string_view stage, double done) {
            return progress(stage, (double(i) + done) / double(count));
        };
    return shared;
}

}  // namespace

Vec3d map_direction(Layout layout, int width, int height, int x, int y) {
    const UV uv{(x + 0.5) / width, (y % height + 0.5) / height};
    return layout == Layout::cube ? normalize(cube_direction(y / height, uv)) : latlong_direction(uv);
}

Result<std::vector<FilterResult>> prefilter(RowSource& source, std::span<const FilterOptions> runs) {
    const LargeMemoryReuse reuse;
    const int width = source.width(), height = source.height(), threads = runs.front().threads;
    std::deque<RowPrefilter> prefilters;
    for (std::size_t i = 0; i < runs.size(); ++i)
        prefilters.emplace_back(width, height, with_shared_progress(runs[i], i, runs.size()));
    MirrorLevels mirrors(width, height, runs);

    ImageF rows(width, std::min(k_chunk_rows, height), 3), copy;
    std::vector<simd::Summary> summaries(k_chunk_rows);
    for (int y = 0; y < height; y += k_chunk_rows) {
        const auto chunk = rows.view().rows(0, std::min(k_chunk_rows, height - y));
        if (auto read = source.read(chunk); !read) return read.error();
        mirrors.add_rows(chunk);
        parallel_ranges(chunk.height, 8, threads, [&](int begin, int end) {
            for (int k = begin; k < end; ++k) summaries[std::size_t(k)] = simd::summarize(chunk.row(k), 3 * width);
        });
        for (RowPrefilter& prefilter : prefilters) {
            const bool copies = prefilter.changes_rows() && &prefilter != &prefilters.back();
            if (copies) copy = rows;
            prefilter.add_rows(copies ? copy.view().rows(0, chunk.height) : chunk, summaries);
        }
        const Progress& progress = runs.front().progress;
        if (progress && !progress("read", double(y + chunk.height) / height)) return k_cancelled;
    }
    rows = copy = {};

    std::vector<FilterResult> results(runs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) results[i].specular.resize(runs[i].specular.size());
    mirrors.finish(results);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (auto done = prefilters.front().finish(results[i]); !done) return done.error();
        prefilters.pop_front();  // its memory is no longer needed
    }
    return results;
}

Result<FilterResult> prefilter(RowSource& source, const FilterOptions& options) {
    auto results = prefilter(source, {&options, 1});
    if (!results) return results.error();
    return std::move(results->front());
}

Result<FilterResult> prefilter(const Cubemap& source, const FilterOptions& options) {
    const LargeMemoryReuse reuse;
    const FilterPlan plan = make_filter_plan(options, false, least_degrees(source.size()));
    FilterResult result;
    result.specular.resize(options.specular.size());
    for (std::size_t l = 0; l < options.specular.size(); ++l) {
        const LevelSpec& level = options.specular[l];
        if (!level.mirror) continue;
        FilteredMap& map = result.specular[l];
        if (options.layout == Layout::cube)
            map = area_resample_cube(source, level.size, options.world_to_source, options.threads);
        else
            map = {Layout::latlong,
                   area_resample_cube_to_latlong(source, level.size, options.world_to_source, options.threads)};
    }
    if (options.progress && !options.progress("read", 1)) return k_cancelled;
    const BorderedCube cube(source);
    SynthesisSource from;
    from.whole = analyse_cube(cube, plan.band_limit, options.threads);
    result.mean = mean_radiance(from.whole);
    result.band_limit = plan.band_limit;
    from.bright = [&](int band_limit) { return bright_points(cube, result.mean, band_limit); };
    if (auto done = make_levels(from, plan, options, result); !done) return done.error();
    return result;
}

Result<FilterResult> prefilter(const Environment& environment, const FilterOptions& options) {
    FilterOptions turned = options;
    turned.world_to_source = environment.world_to_source * options.world_to_source;
    if (const Cubemap* cube = environment.cube()) return prefilter(*cube, turned);
    const auto rows = environment.rows();
    if (!rows) return rows.error();
    return prefilter(**rows, turned);
}

}  // namespace domelight
