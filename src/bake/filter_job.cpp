#include "bake/filter_job.h"

#include "domelight/area_resample.h"

#include "bake/tap.h"
#include "core/sha256.h"

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

}  // namespace

std::size_t FilterJob::add(const LevelSpec& spec) {
    const auto at = std::find_if(specs_.begin(), specs_.end(), [&](const LevelSpec& s) { return same_level(s, spec); });
    if (at != specs_.end()) return std::size_t(at - specs_.begin());
    specs_.push_back(spec);
    return specs_.size() - 1;
}

FilterJob::FilterJob(const std::vector<TargetPlan>& plans) : targets_(plans.size()) {
    const auto index_of = [](std::vector<int>& sizes, int size) {
        const auto at = std::find(sizes.begin(), sizes.end(), size);
        if (at != sizes.end()) return std::size_t(at - sizes.begin());
        sizes.push_back(size);
        return sizes.size() - 1;
    };
    for (std::size_t t = 0; t < plans.size(); ++t) {
        // Where a target only wants the environment, the irradiance serves the harmonics' error alone: its layout does
        // not matter.
        targets_[t].irradiance = index_of(irradiance_sizes_, plans[t].irradiance_size);
        if (plans[t].target->environment_only) continue;
        layout_ = plans[t].layout;
        for (const LevelPlan& level : plans[t].specular) targets_[t].specular.push_back(add(level.spec));
        for (const LevelPlan& level : plans[t].sheen) targets_[t].sheen.push_back(add(level.spec));
    }
    for (std::size_t t = 0; t < plans.size(); ++t)
        if (plans[t].target->environment_only)
            targets_[t].specular = {specs_.size() + index_of(panorama_heights_, plans[t].specular.front().spec.size)};
}

Result<void> FilterJob::filter_rows(RowSource& rows, const FilterOptions& filter, const BakeOptions& options) {
    Result<FilterResult> result = [&]() -> Result<FilterResult> {
        if (options.method == BakeMethod::exact) return prefilter(rows, filter);
        const auto image = read_latlong(rows);
        if (!image) return image.error();
        return prefilter_reference(*image, filter, reference_options(options));
    }();
    if (!result) return result.error();
    result_ = *std::move(result);
    return {};
}

Result<void> FilterJob::filter_cube(const Environment& environment, const FilterOptions& filter,
                                    const BakeOptions& options) {
    if (options.method == BakeMethod::exact) {
        auto result = prefilter(environment.cube, filter);
        if (!result) return result.error();
        result_ = *std::move(result);
        return {};
    }
    // The plain methods read lat-long images: the cube as one, in its own frame.
    const ImageF image =
        area_resample_cube_to_latlong(environment.cube, 2 * environment.cube.size(), Mat3{}, options.threads);
    auto result = prefilter_reference(image, filter, reference_options(options));
    if (!result) return result.error();
    result_ = *std::move(result);
    return {};
}

Result<void> FilterJob::run(Environment& environment, const BakeOptions& options) {
    FilterOptions filter;
    filter.layout = layout_;
    filter.specular = specs_;
    filter.irradiance_size = irradiance_sizes_.front();
    for (std::size_t i = 1; i < irradiance_sizes_.size(); ++i)
        filter.specular.push_back({irradiance_sizes_[i], false, ZonalKernel::cosine()});
    filter.sh_bands = options.sh_bands;
    filter.world_to_source = environment.world_to_source;
    filter.threads = options.threads;
    filter.progress = options.progress;

    std::vector<ImageF> panoramas;
    if (environment.latlong) {
        std::vector<std::unique_ptr<AreaResampler>> resamplers;
        const int width = environment.latlong->width(), height = environment.latlong->height();
        for (const int h : panorama_heights_)
            resamplers.push_back(
                area_resample_to_latlong(width, height, h, environment.world_to_source, options.threads));
        Sha256 hash;
        const bool hash_rows = environment.file.empty() && options.hashes;
        TapRowSource tap(*environment.latlong, [&](ImageView<const float> rows) {
            for (auto& resampler : resamplers) resampler->add_rows(rows);
            for (int y = 0; hash_rows && y < rows.height; ++y)
                hash.add({reinterpret_cast<const std::uint8_t*>(rows.row(y)),
                          std::size_t(rows.width) * rows.channels * sizeof(float)});
        });
        if (auto ok = filter_rows(tap, filter, options); !ok) return ok;
        for (auto& resampler : resamplers) panoramas.push_back(resampler->finish());
        if (hash_rows) rows_sha256_ = hash.finish();
    } else {
        if (auto ok = filter_cube(environment, filter, options); !ok) return ok;
        for (const int h : panorama_heights_)
            panoramas.push_back(
                area_resample_cube_to_latlong(environment.cube, h, environment.world_to_source, options.threads));
    }
    irradiance_.push_back(std::move(result_.irradiance_over_pi));
    for (std::size_t i = specs_.size(); i < result_.specular.size(); ++i)
        irradiance_.push_back(std::move(result_.specular[i]));
    result_.specular.resize(specs_.size());
    for (ImageF& panorama : panoramas) {
        FilteredMap map;
        map.latlong = std::move(panorama);
        result_.specular.push_back(std::move(map));
    }
    return {};
}

std::vector<FilteredMap> FilterJob::take(const std::vector<std::size_t>& indices) {
    std::vector<FilteredMap> maps;
    for (const std::size_t i : indices)
        maps.push_back(std::move(result_.specular[i]));  // the levels of a chain differ in size
    return maps;
}

void FilterJob::give_back(const std::vector<std::size_t>& indices, std::vector<FilteredMap> maps) {
    for (std::size_t i = 0; i < indices.size(); ++i) result_.specular[indices[i]] = std::move(maps[i]);
}

FilterJob::Maps FilterJob::take(std::size_t target) {
    const Indices& indices = targets_[target];
    Maps maps;
    maps.specular = take(indices.specular);
    maps.sheen = take(indices.sheen);
    maps.irradiance_over_pi = std::move(irradiance_[indices.irradiance]);
    return maps;
}

void FilterJob::give_back(std::size_t target, Maps maps) {
    const Indices& indices = targets_[target];
    give_back(indices.specular, std::move(maps.specular));
    give_back(indices.sheen, std::move(maps.sheen));
    irradiance_[indices.irradiance] = std::move(maps.irradiance_over_pi);
}

}  // namespace domelight
