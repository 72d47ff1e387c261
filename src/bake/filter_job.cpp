#include "bake/filter_job.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/row_source.h"

#include "bake/tap.h"
#include "base/sha256.h"
#include "io/environment/convert_rows.h"

#include <algorithm>

namespace domelight {
namespace {

bool same_level(const LevelSpec& a, const LevelSpec& b) {
    return a.size == b.size && a.mirror == b.mirror &&
           (a.mirror || (a.kernel.lobe == b.kernel.lobe && a.kernel.width == b.kernel.width));
}

ReferenceOptions reference_options(const BakeOptions& o) {
    ReferenceOptions r;
    r.method = o.method == BakeMethod::riemann      ? ReferenceMethod::riemann
               : o.method == BakeMethod::montecarlo ? ReferenceMethod::montecarlo
                                                    : ReferenceMethod::bruteforce;
    r.riemann_polar = o.riemann_polar;
    r.riemann_azimuth = o.riemann_azimuth;
    r.samples = o.samples;
    return r;
}

/// The maps of one run from rows.
Result<FilterResult> filter(RowSource& rows, const FilterOptions& filter, const BakeOptions& options) {
    if (options.method == BakeMethod::exact) return prefilter(rows, filter);
    const auto image = read_latlong(rows);
    if (!image) return image.error();
    return prefilter_reference(*image, filter, reference_options(options));
}

ImageF reprojected(const ProjectedImage& source, const PanoramaSpec& spec, const BakeOptions& options) {
    return std::move(
        reproject(source, *projection_from_name(spec.projection), spec.width, spec.height, options.threads).pixels);
}

template <typename T>
std::size_t index_of(std::vector<T>& values, const T& value) {
    const auto at = std::find(values.begin(), values.end(), value);
    if (at != values.end()) return std::size_t(at - values.begin());
    values.push_back(value);
    return values.size() - 1;
}

}  // namespace

std::size_t FilterJob::Run::add(const LevelSpec& spec) {
    const auto at = std::find_if(specs.begin(), specs.end(), [&](const LevelSpec& s) { return same_level(s, spec); });
    if (at != specs.end()) return std::size_t(at - specs.begin());
    specs.push_back(spec);
    return specs.size() - 1;
}

std::size_t FilterJob::run_of(Layout layout) {
    const auto at = std::find_if(runs_.begin(), runs_.end(), [&](const Run& r) { return r.layout == layout; });
    if (at != runs_.end()) return std::size_t(at - runs_.begin());
    runs_.emplace_back().layout = layout;
    return runs_.size() - 1;
}

FilterJob::FilterJob(const std::vector<EnginePlan>& plans) : engines_(plans.size()) {
    for (std::size_t e = 0; e < plans.size(); ++e) {
        const EnginePlan& plan = plans[e];
        Indices& indices = engines_[e];
        if (plan.panorama) indices.panorama = index_of(panorama_specs_, *plan.panorama);
        if (plan.engine->environment_only) continue;
        indices.run = run_of(plan.layout);
        for (const LevelPlan& level : plan.specular) indices.specular.push_back(runs_[indices.run].add(level.spec));
        for (const LevelPlan& level : plan.sheen) indices.sheen.push_back(runs_[indices.run].add(level.spec));
    }
    // Where an engine only wants the environment, the irradiance serves the harmonics' error alone: its layout does not
    // matter.
    if (runs_.empty()) runs_.emplace_back();
    for (std::size_t e = 0; e < plans.size(); ++e)
        engines_[e].irradiance = index_of(runs_[engines_[e].run].irradiance_sizes, plans[e].irradiance_size);
}

FilterOptions FilterJob::Run::options(const Environment& environment, const BakeOptions& options) const {
    FilterOptions filter;
    filter.layout = layout;
    filter.specular = specs;
    filter.irradiance_size = irradiance_sizes.front();
    for (std::size_t i = 1; i < irradiance_sizes.size(); ++i)
        filter.specular.push_back({irradiance_sizes[i], false, ZonalKernel::cosine()});
    filter.sh_bands = options.sh_bands;
    filter.world_to_source = environment.world_to_source;
    filter.threads = options.threads;
    filter.progress = options.progress;
    return filter;
}

void FilterJob::Run::sort_out() {
    irradiance.push_back(std::move(result.irradiance_over_pi));
    for (std::size_t i = specs.size(); i < result.specular.size(); ++i)
        irradiance.push_back(std::move(result.specular[i]));
    result.specular.resize(specs.size());
}

Result<void> FilterJob::read_rows(Environment& environment, const BakeOptions& options) {
    std::vector<RowConversion> conversions;
    for (const PanoramaSpec& spec : panorama_specs_)
        conversions.push_back(convert_rows(environment.latlong->width(), environment.latlong->height(),
                                           *projection_from_name(spec.projection), spec.width, spec.height,
                                           environment.world_to_source, options.threads));
    const bool whole = std::any_of(conversions.begin(), conversions.end(), [](const auto& c) { return !c.rows; });
    Sha256 hash;
    const bool hash_rows = environment.file.empty() && options.hashes;
    TapRowSource tap(*environment.latlong, [&](ImageView<const float> rows) {
        for (const RowConversion& conversion : conversions)
            if (conversion.rows) conversion.rows->add_rows(rows);
        for (int y = 0; hash_rows && y < rows.height; ++y)
            hash.add({reinterpret_cast<const std::uint8_t*>(rows.row(y)),
                      std::size_t(rows.width) * rows.channels * sizeof(float)});
    });
    // The rows come once: where something needs them again, all of them are kept.
    ImageF kept;
    if (runs_.size() > 1 || whole) {
        auto image = read_latlong(tap);
        if (!image) return image.error();
        kept = *std::move(image);
    }
    for (Run& run : runs_) {
        ImageRowSource memory(kept.view());
        RowSource& rows = kept.empty() ? static_cast<RowSource&>(tap) : memory;
        auto result = filter(rows, run.options(environment, options), options);
        if (!result) return result.error();
        run.result = *std::move(result);
    }
    const ProjectedImage source{projection_from_name("latlong")->turned(environment.world_to_source), std::move(kept)};
    for (std::size_t i = 0; i < conversions.size(); ++i)
        panoramas_.push_back(conversions[i].rows ? conversions[i].rows->finish()
                                                 : reprojected(source, panorama_specs_[i], options));
    if (hash_rows) rows_sha256_ = hash.finish();
    return {};
}

Result<void> FilterJob::filter_cube(Environment& environment, const BakeOptions& options) {
    for (Run& run : runs_) {
        const FilterOptions filter_options = run.options(environment, options);
        if (options.method == BakeMethod::exact) {
            auto result = prefilter(environment.cube, filter_options);
            if (!result) return result.error();
            run.result = *std::move(result);
            continue;
        }
        // The plain methods read lat-long images: the cube as one, in its own frame.
        const ImageF image =
            area_resample_cube_to_latlong(environment.cube, 2 * environment.cube.size(), Mat3{}, options.threads);
        auto result = prefilter_reference(image, filter_options, reference_options(options));
        if (!result) return result.error();
        run.result = *std::move(result);
    }
    if (panorama_specs_.empty()) return {};
    const ImageView<const float> strip = std::as_const(environment.cube).strip();
    ImageF pixels(strip.width, strip.height, 3);
    std::copy_n(strip.data, pixels.pixels().size(), pixels.pixels().begin());
    const ProjectedImage source{projection_from_name("cube")->turned(environment.world_to_source), std::move(pixels)};
    for (const PanoramaSpec& spec : panorama_specs_) panoramas_.push_back(reprojected(source, spec, options));
    return {};
}

Result<void> FilterJob::run(Environment& environment, const BakeOptions& options) {
    const auto done = environment.latlong ? read_rows(environment, options) : filter_cube(environment, options);
    if (!done) return done;
    for (Run& run : runs_) run.sort_out();
    return {};
}

std::int64_t FilterJob::clamped() const {
    std::int64_t count = 0;
    for (const Run& run : runs_) count += run.result.clamped;
    return count;
}

int FilterJob::band_limit() const {
    int limit = 0;
    for (const Run& run : runs_) limit = std::max(limit, run.result.band_limit);
    return limit;
}

std::vector<FilteredMap> FilterJob::take(Run& run, const std::vector<std::size_t>& indices) {
    std::vector<FilteredMap> maps;
    for (const std::size_t i : indices)
        maps.push_back(std::move(run.result.specular[i]));  // the levels of a chain differ in size
    return maps;
}

void FilterJob::give_back(Run& run, const std::vector<std::size_t>& indices, std::vector<FilteredMap> maps) {
    for (std::size_t i = 0; i < indices.size(); ++i) run.result.specular[indices[i]] = std::move(maps[i]);
}

FilterJob::Maps FilterJob::take(std::size_t engine) {
    const Indices& indices = engines_[engine];
    Run& run = runs_[indices.run];
    Maps maps;
    maps.specular = take(run, indices.specular);
    maps.sheen = take(run, indices.sheen);
    maps.irradiance_over_pi = std::move(run.irradiance[indices.irradiance]);
    if (!indices.panorama) return maps;
    maps.panorama = std::move(panoramas_[*indices.panorama]);
    return maps;
}

void FilterJob::give_back(std::size_t engine, Maps maps) {
    const Indices& indices = engines_[engine];
    Run& run = runs_[indices.run];
    if (indices.panorama) panoramas_[*indices.panorama] = std::move(maps.panorama);
    give_back(run, indices.specular, std::move(maps.specular));
    give_back(run, indices.sheen, std::move(maps.sheen));
    run.irradiance[indices.irradiance] = std::move(maps.irradiance_over_pi);
}

}  // namespace domelight
