#include "filtering/level_synthesis.h"

#include "domelight/base/parallel.h"
#include "domelight/filtering/resample/area_resample.h"

#include "filtering/harmonic/scatter_analysis.h"
#include "filtering/harmonic/spectrum_evaluate.h"
#include "filtering/lights/light_groups.h"
#include "filtering/read_texels.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace domelight {
namespace {

ZonalKernel kernel_of_level(const FilterOptions& options, int level) {
    return level == FilterPlan::k_irradiance ? ZonalKernel::cosine() : options.specular[std::size_t(level)].kernel;
}

/// The levels of a plan that are synthesised together, one batch after the other.
std::vector<std::span<const int>> batches_of(const FilterPlan::Group& group) {
    // A few at a time: a grid of many degrees is hundreds of megabytes.
    const std::size_t at_once = group.band_limit > 1200 ? 1 : 4;
    std::vector<std::span<const int>> batches;
    for (std::size_t from = 0; from < group.levels.size(); from += at_once)
        batches.emplace_back(group.levels.data() + from, std::min(at_once, group.levels.size() - from));
    return batches;
}

/// The degrees to which bright lights are expanded; 0: no level leaves a residual.
int lights_band_limit(const FilterPlan& plan, const FilterOptions& options) {
    int band_limit = 0;
    for (const FilterPlan::Group& group : plan.groups)
        for (const int level : group.levels)
            if (leaves_residual(kernel_of_level(options, level))) band_limit = std::max(band_limit, group.band_limit);
    return band_limit;
}

/// Of each channel, the least value of a level, but not below a hundredth of the mean: an error is judged against this.
Vec3d least_values(const SphereGrid& grid, const Vec3d& mean) {
    simd::Texel least{1e30f, 1e30f, 1e30f};
    for (int k = 0; k < grid.grid().rings; ++k) least = simd::least(grid.ring(k), grid.grid().width, least);
    return {std::max(double(least.r), 0.01 * mean.x), std::max(double(least.g), 0.01 * mean.y),
            std::max(double(least.b), 0.01 * mean.z)};
}

/// Makes the levels of a plan, batch by batch.
class Synthesis {
  public:
    Synthesis(const SynthesisSource& source, const FilterPlan& plan, const FilterOptions& options, FilterResult& result,
              const PreparedLevels* prepared)
        : source_(source), options_(options), result_(result), prepared_(prepared) {
        prepare_lights(plan);
    }

    Result<void> run(const FilterPlan& plan) {
        std::size_t next = 0, all = 0;
        for (const FilterPlan::Group& group : plan.groups) all += group.levels.size();
        for (const FilterPlan::Group& group : plan.groups)
            for (const std::span<const int> levels : batches_of(group)) {
                if (prepared_)
                    synthesise(prepared_->batches[next++]);
                else
                    synthesise({group, levels, options_, !lights_.empty(), grid_transform(group.band_limit)});
                done_ += levels.size();
                if (options_.progress && !options_.progress("filter", double(done_) / double(all))) return k_cancelled;
            }
        return {};
    }

  private:
    /// The lights of all levels that leave a residual, and their coefficients.
    void prepare_lights(const FilterPlan& plan) {
        const int band_limit = lights_band_limit(plan, options_);
        if (band_limit == 0) return;
        const PointLights points = source_.bright(band_limit);
        if (points.count() == 0) return;
        lights_ = LightGroups(points);
        lights_spectrum_ =
            analyse_lights(points, prepared_ ? prepared_->lights : grid_transform(band_limit), options_.threads);
    }

    std::vector<SphereGrid> grids(const LevelBatch& batch) const {
        const bool split = batch.narrow && source_.split;
        const Spectrum& spectrum = split ? source_.rest : source_.whole;
        if (!lights_.empty())
            return sh_synthesis(spectrum, &lights_spectrum_, batch.factors, *batch.transform, options_.threads);
        std::vector<SynthesisFactors> factors = batch.factors;
        for (SynthesisFactors& of_kernel : factors) of_kernel.r.clear();
        return sh_synthesis(spectrum, nullptr, factors, *batch.transform, options_.threads);
    }

    void synthesise(const LevelBatch& batch) {
        const bool split = batch.narrow && source_.split;
        const std::vector<SphereGrid> of_kernels = grids(batch);
        for (std::size_t i = 0; i < batch.kernels.size(); ++i) {
            const SphereGrid& grid = of_kernels[i];
            LookupOptions lookup;
            lookup.band = double(batch.band_limit) / grid.grid().rings;
            lookup.world_to_source = options_.world_to_source;
            lookup.threads = options_.threads;
            std::optional<ResidualLights> residual;
            if (batch.residuals[i] && !lights_.empty()) {
                residual.emplace(lights_, *batch.residuals[i], least_values(grid, result_.mean));
                lookup.residual = &*residual;
            }
            BrightSplit::Lights lights;
            std::optional<DirectKernelTable> direct;
            if (split) {
                lights = source_.split->lights(batch.kernels[i]);
                direct.emplace(batch.kernels[i]);
                lookup.lights = &lights, lookup.kernel = direct->view();
            }
            for (std::size_t l = 0; l < batch.levels.size(); ++l)
                if (batch.kernel_of[l] == i) look_up(batch.levels[l], batch.kernels[i], grid, lookup);
        }
    }

    void look_up(int level, const ZonalKernel& kernel, const SphereGrid& grid, const LookupOptions& lookup) {
        const bool irradiance = level == FilterPlan::k_irradiance;
        const int size = irradiance ? options_.irradiance_size : options_.specular[std::size_t(level)].size;
        FilteredMap& map = irradiance ? result_.irradiance_over_pi : result_.specular[std::size_t(level)];
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
    const PreparedLevels* prepared_;
    LightGroups lights_;
    Spectrum lights_spectrum_;
    std::size_t done_ = 0;
};

}  // namespace

LevelBatch::LevelBatch(const FilterPlan::Group& group, std::span<const int> of_levels, const FilterOptions& options,
                       bool splits, std::shared_ptr<const RingTransform> with)
    : band_limit(group.band_limit),
      narrow(group.narrow),
      levels(of_levels.begin(), of_levels.end()),
      transform(std::move(with)) {
    for (const int level : levels) {
        const ZonalKernel kernel = kernel_of_level(options, level);
        const auto found = std::find(kernels.begin(), kernels.end(), kernel);
        kernel_of.push_back(std::size_t(found - kernels.begin()));
        if (found == kernels.end()) kernels.push_back(kernel);
    }
    factors.resize(kernels.size());
    residuals.resize(kernels.size());
    parallel_for(int(kernels.size()), options.threads, [&](int i) {
        factors[i].k = kernels[i].coefficients(band_limit);
        if (!splits || !leaves_residual(kernels[i])) return;
        residuals[i] = std::make_unique<ResidualKernel>(kernels[i], factors[i].k);
        factors[i].r = residuals[i]->removed();
    });
}

PreparedLevels::PreparedLevels(const FilterPlan& plan, const FilterOptions& options) {
    for (const FilterPlan::Group& group : plan.groups)
        for (const std::span<const int> levels : batches_of(group))
            batches.emplace_back(group, levels, options, true, transform(group.band_limit));
    if (const int band_limit = lights_band_limit(plan, options)) lights = transform(band_limit);
}

std::shared_ptr<const RingTransform> PreparedLevels::transform(int band_limit) {
    /// The Legendre functions of more degrees would take a hundred megabytes.
    constexpr int k_most_kept = 320;
    for (const auto& made : transforms_)
        if (made->band_limit == band_limit) return made;
    return transforms_.emplace_back(grid_transform(band_limit, band_limit <= k_most_kept));
}

Vec3d mean_radiance(const Spectrum& spectrum) {
    const double y00 = 1 / std::sqrt(4 * k_pi);
    return Vec3d{spectrum.coefficient(0, 0, 0).real(), spectrum.coefficient(0, 0, 1).real(),
                 spectrum.coefficient(0, 0, 2).real()} *
           y00;
}

void fill_mirror_levels(const Cubemap& source, const FilterOptions& options, FilterResult& result) {
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
}

Result<void> make_levels(const SynthesisSource& source, const FilterPlan& plan, const FilterOptions& options,
                         FilterResult& result, const PreparedLevels* prepared) {
    if (auto done = Synthesis(source, plan, options, result, prepared).run(plan); !done) return done;
    if (options.sh_bands > 0) result.sh = spectrum_to_sh(source.whole, options.sh_bands, options.world_to_source);
    return {};
}

}  // namespace domelight
