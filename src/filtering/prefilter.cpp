#include "domelight/base/parallel.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/projection/projection.h"

#include "base/large_memory.h"
#include "filtering/direct/direct_sums.h"
#include "filtering/filter_plan.h"
#include "filtering/harmonic/bright_texels.h"
#include "filtering/cube/cube_analysis.h"
#include "filtering/harmonic/sh_analysis.h"
#include "filtering/level_synthesis.h"
#include "filtering/prefilter_runs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>

namespace domelight {
namespace {

/// The number of image rows processed together: few enough to stay in the cache from the reader to the last step.
constexpr int k_chunk_rows = 64;

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
    const FilterPlan plan = make_filter_plan(options, false, {.least = least_degrees(source.size())});
    FilterResult result;
    result.specular.resize(options.specular.size());
    fill_mirror_levels(source, options, result);
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
