#include "bake/filter_job.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/row_source.h"

#include "bake/tap.h"
#include "filtering/prefilter_runs.h"
#include "io/environment/convert_rows.h"
#include "io/file/sha256.h"

#include <algorithm>
#include <functional>
#include <span>

namespace domelight {
namespace {

bool same_level(const LevelSpec& a, const LevelSpec& b) {
    return a.size == b.size && a.mirror == b.mirror && (a.mirror || a.kernel == b.kernel);
}

/// Of two runs over one environment.
bool same_run(const FilterOptions& a, const FilterOptions& b) {
    return a.layout == b.layout && a.texels == b.texels && a.irradiance_size == b.irradiance_size &&
           std::equal(a.specular.begin(), a.specular.end(), b.specular.begin(), b.specular.end(), same_level);
}

FilterOptions filter_options(const EnginePlan& plan, const Environment& environment, const BakeOptions& options) {
    FilterOptions filter;
    if (!plan.engine->environment_only) {
        filter.layout = plan.layout;
        filter.texels = plan.texels;
        for (const LevelPlan& level : plan.specular) filter.specular.push_back(level.spec);
        for (const LevelPlan& level : plan.sheen) filter.specular.push_back(level.spec);
        filter.specular.insert(filter.specular.end(), plan.gap_probes.begin(), plan.gap_probes.end());
    }
    filter.irradiance_size = plan.irradiance_size;  // the harmonics' error is measured against it in any case
    filter.sh_bands = options.sh_bands;
    filter.world_to_source = environment.world_to_source;
    filter.threads = options.threads;
    filter.progress = options.progress;
    return filter;
}

ReferenceOptions reference_options(const BakeOptions& o) {
    ReferenceOptions r;
    r.method = o.method == BakeMethod::riemann      ? ReferenceMethod::riemann
               : o.method == BakeMethod::montecarlo ? ReferenceMethod::montecarlo
                                                    : ReferenceMethod::bruteforce;
    r.riemann = o.riemann;
    r.points = o.points;
    return r;
}

/// All runs by one of the plain methods, which need the whole image.
Result<std::vector<FilterResult>> filter_plainly(const ImageF& image, std::span<const FilterOptions> runs,
                                                 const BakeOptions& options) {
    std::vector<FilterResult> results;
    for (const FilterOptions& run : runs) {
        auto result = prefilter_reference(image, run, reference_options(options));
        if (!result) return result.error();
        results.push_back(*std::move(result));
    }
    return results;
}

ImageF reprojected(const ProjectedImage& source, const PanoramaSpec& spec, const BakeOptions& options) {
    return std::move(
        reproject(source, *projection_from_name(spec.projection), spec.width, spec.height, options.threads).pixels);
}

/// The index of the element that is `same` as `value`, which is added if there is none.
template <typename T, typename Same>
std::size_t index_of(std::vector<T>& values, T value, const Same& same) {
    const auto at = std::find_if(values.begin(), values.end(), [&](const T& v) { return same(v, value); });
    if (at != values.end()) return std::size_t(at - values.begin());
    values.push_back(std::move(value));
    return values.size() - 1;
}

}  // namespace

FilterJob::FilterJob(const std::vector<EnginePlan>& plans, const Environment& environment, const BakeOptions& options) {
    for (const EnginePlan& plan : plans) {
        Indices& indices = engines_.emplace_back();
        indices.plan = &plan;
        indices.run = index_of(runs_, filter_options(plan, environment, options), same_run);
        if (plan.panorama) indices.panorama = index_of(panorama_specs_, *plan.panorama, std::equal_to());
    }
}

Result<void> FilterJob::read_rows(const Environment& environment, const BakeOptions& options) {
    std::vector<RowConversion> conversions;
    for (const PanoramaSpec& spec : panorama_specs_)
        conversions.push_back(convert_rows(environment.latlong_width(), environment.latlong_height(),
                                           *projection_from_name(spec.projection), spec.width, spec.height,
                                           environment.world_to_source, options.threads));
    const bool whole = std::any_of(conversions.begin(), conversions.end(), [](const auto& c) { return !c.rows; });
    Sha256 hash;
    const bool hash_rows = environment.file.empty() && options.hashes;
    const auto source_rows = environment.rows();
    if (!source_rows) return source_rows.error();
    TapRowSource tap(**source_rows, [&](ImageView<const float> rows) {
        for (const RowConversion& conversion : conversions)
            if (conversion.rows) conversion.rows->add_rows(rows);
        for (int y = 0; hash_rows && y < rows.height; ++y)
            hash.add({reinterpret_cast<const std::uint8_t*>(rows.row(y)),
                      std::size_t(rows.width) * rows.channels * sizeof(float)});
    });
    // Where something needs the whole image, all rows are kept.
    const bool plain = options.method != BakeMethod::exact;
    ImageF kept;
    if (plain || whole) {
        auto image = read_latlong(tap);
        if (!image) return image.error();
        kept = *std::move(image);
    }
    ImageRowSource memory(kept.view());
    RowSource& rows = kept.empty() ? static_cast<RowSource&>(tap) : memory;
    auto results = plain ? filter_plainly(kept, runs_, options) : prefilter(rows, runs_);
    if (!results) return results.error();
    results_ = *std::move(results);
    const ProjectedImage source{projection_from_name("latlong")->turned(environment.world_to_source), std::move(kept)};
    for (std::size_t i = 0; i < conversions.size(); ++i)
        panoramas_.emplace_back(Layout::latlong, conversions[i].rows
                                                     ? conversions[i].rows->finish()
                                                     : reprojected(source, panorama_specs_[i], options));
    if (hash_rows) rows_sha256_ = hash.finish();
    return {};
}

Result<void> FilterJob::filter_cube(const Environment& environment, const BakeOptions& options) {
    const Cubemap& cube = *environment.cube();
    if (options.method == BakeMethod::exact) {
        for (const FilterOptions& run : runs_) {
            auto result = prefilter(cube, run);
            if (!result) return result.error();
            results_.push_back(*std::move(result));
        }
    } else {
        // The plain methods read lat-long images: the cube as one, in its own frame.
        const auto image = environment.latlong();
        if (!image) return image.error();
        auto results = filter_plainly(**image, runs_, options);
        if (!results) return results.error();
        results_ = *std::move(results);
    }
    if (panorama_specs_.empty()) return {};
    const ProjectedImage source = projected_cube(cube, environment.world_to_source);
    for (const PanoramaSpec& spec : panorama_specs_)
        panoramas_.emplace_back(Layout::latlong, reprojected(source, spec, options));
    return {};
}

Result<void> FilterJob::run(const Environment& environment, const BakeOptions& options) {
    return environment.cube() ? filter_cube(environment, options) : read_rows(environment, options);
}

std::int64_t FilterJob::clamped() const {
    std::int64_t count = 0;
    for (const FilterResult& result : results_) count += result.clamped;
    return count;
}

int FilterJob::band_limit() const {
    int limit = 0;
    for (const FilterResult& result : results_) limit = std::max(limit, result.band_limit);
    return limit;
}

FilterJob::Maps FilterJob::maps(std::size_t engine) const {
    const Indices& indices = engines_[engine];
    const FilterResult& result = results_[indices.run];
    std::span<const FilteredMap> rest = result.specular;
    const auto next = [&](std::size_t count) {
        const auto part = rest.first(count);
        rest = rest.subspan(count);
        return part;
    };
    // As filter_options() lists them.
    Maps maps;
    maps.irradiance_over_pi = &result.irradiance_over_pi;
    if (indices.panorama) maps.panorama = &panoramas_[*indices.panorama];
    if (indices.plan->engine->environment_only) return maps;
    maps.specular = next(indices.plan->specular.size());
    maps.sheen = next(indices.plan->sheen.size());
    maps.gap_probes = next(indices.plan->gap_probes.size());
    return maps;
}

}  // namespace domelight
