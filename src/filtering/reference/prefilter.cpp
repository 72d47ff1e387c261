// prefilter_reference: one texel after the other, by the plain method that is asked for.
#include "domelight/base/parallel.h"

#include "filtering/reference/sampling.h"

#include <cstdint>

namespace domelight {
namespace {

/// A level that is being computed: the direction of a point of a texel, and the position of the texel.
class Grid {
  public:
    Grid(Layout layout, int size)
        : layout_(layout),
          size_(size),
          map_(layout == Layout::cube ? FilteredMap(Cubemap(size)) : FilteredMap(layout, ImageF(2 * size, size, 3))) {}
    int width() const { return map_.width(); }
    std::int64_t texels() const { return std::int64_t(map_.pixels().size() / 3); }
    /// Direction (not normalised) at (s, t) in [0, 1]^2 of texel i, rows of faces from the first one down.
    Vec3d direction(std::int64_t i, double s, double t) const {
        const int x = int(i % width()), y = int(i / width());
        if (layout_ == Layout::cube) return cube_direction(y / size_, {(x + s) / size_, (y % size_ + t) / size_});
        return latlong_direction({(x + s) / width(), (y + t) / size_});
    }
    /// Solid angle per area of the texel at that point, up to a factor.
    double jacobian(std::int64_t i, double s, double t) const {
        const Vec3d d = direction(i, s, t);
        return layout_ == Layout::cube ? std::pow(dot(d, d), -1.5) : std::hypot(d.x, d.z);
    }
    void set(std::int64_t i, const Vec3d& value) {
        float* p = map_.pixels().data() + 3 * i;
        p[0] = float(value.x), p[1] = float(value.y), p[2] = float(value.z);
    }
    FilteredMap take() { return std::move(map_); }

  private:
    Layout layout_;
    int size_;
    FilteredMap map_;
};

/// Counts texels for the progress callback; false after the callback has returned false.
class Report {
  public:
    Report(const Progress& progress, std::int64_t total) : progress_(progress), total_(total) {}
    bool advance(std::int64_t texels) {
        done_ += texels;
        return !progress_ || progress_("filter", double(done_) / double(total_));
    }

  private:
    const Progress& progress_;
    std::int64_t total_, done_ = 0;
};

constexpr std::int64_t k_batch = 4096;  ///< texels between two calls of the progress callback

/// The mean over each texel from n x n midpoints of the bilinear reconstruction, weighted by solid angle: 4 samples to
/// a source texel and direction, 8 at least, 32 at most.
bool fill_mirror(Grid& grid, const ReferenceSource& source, const FilterOptions& options, Report& report) {
    const double across =
        options.layout == Layout::cube ? 4.0 * grid.width() : grid.width();  // texels around the equator
    const int n = std::clamp(int(std::ceil(4 * source.width() / across)), 8, 32);
    for (std::int64_t first = 0; first < grid.texels(); first += k_batch) {
        const int count = int(std::min(k_batch, grid.texels() - first));
        parallel_ranges(count, 64, options.threads, [&](int begin, int end) {
            for (std::int64_t i = first + begin; i < first + end; ++i) {
                Vec3d sum;
                double weights = 0;
                for (int a = 0; a < n; ++a)
                    for (int b = 0; b < n; ++b) {
                        const double s = (b + 0.5) / n, t = (a + 0.5) / n, weight = grid.jacobian(i, s, t);
                        sum += source.lookup(options.world_to_source * grid.direction(i, s, t)) * weight;
                        weights += weight;
                    }
                grid.set(i, sum / weights);
            }
        });
        if (!report.advance(count)) return false;
    }
    return true;
}

bool fill(Grid& grid, ImageView<const float> latlong, const ReferenceSource& source, const ZonalKernel& kernel,
          const FilterOptions& options, const ReferenceOptions& reference, Report& report) {
    for (std::int64_t first = 0; first < grid.texels(); first += k_batch) {
        const int count = int(std::min(k_batch, grid.texels() - first));
        std::vector<Vec3d> axes(count), values(count);
        for (int i = 0; i < count; ++i)
            axes[i] = normalize(options.world_to_source * grid.direction(first + i, 0.5, 0.5));
        if (reference.method == ReferenceMethod::bruteforce) {
            values = convolve_exactly(latlong, kernel, axes, options.threads);
        } else {
            parallel_ranges(count, 16, options.threads, [&](int begin, int end) {
                for (int i = begin; i < end; ++i)
                    values[i] = reference.method == ReferenceMethod::riemann
                                    ? riemann_sum(source, kernel, axes[i], reference.riemann)
                                    : montecarlo_sum(source, kernel, axes[i], reference.points);
            });
        }
        for (int i = 0; i < count; ++i) grid.set(first + i, values[i]);
        if (!report.advance(count)) return false;
    }
    return true;
}

bool valid(const ZonalKernel& kernel) {
    const bool phong = is_phong(kernel.lobe);
    return kernel.width >= 0 && (phong ? std::isfinite(kernel.width) : kernel.width <= 1);
}

Result<void> check(ImageView<const float> latlong, const FilterOptions& options, const ReferenceOptions& reference) {
    if (latlong.width < 1 || latlong.height < 1 || latlong.channels != 3)
        return Error{"the environment must be an RGB image of at least 1 x 1", "", ""};
    if (reference.riemann.phi_steps < 1 || reference.riemann.theta_steps < 1)
        return Error{"a Riemann sum needs at least one step each way", "", ""};
    if (reference.points.count < 1) return Error{"Monte Carlo needs at least one sample", "", ""};
    for (const LevelSpec& level : options.specular) {
        if (level.size < 1) return Error{"a level must be at least one texel wide", "", ""};
        if (!level.mirror && !valid(level.kernel))
            return Error{"a lobe's alpha must lie in 0 .. 1, an exponent at 0 or above", "", ""};
    }
    if (options.irradiance_size < 0 || options.sh_bands < 0)
        return Error{"sizes and numbers of bands must not be negative", "", ""};
    return {};
}

std::int64_t all_texels(const FilterOptions& options) {
    std::int64_t total =
        std::int64_t(options.layout == Layout::cube ? 6 : 2) * options.irradiance_size * options.irradiance_size;
    for (const LevelSpec& level : options.specular)
        total += std::int64_t(options.layout == Layout::cube ? 6 : 2) * level.size * level.size;
    return std::max<std::int64_t>(total, 1);
}

}  // namespace

Result<FilterResult> prefilter_reference(ImageView<const float> latlong, const FilterOptions& options,
                                         const ReferenceOptions& reference) {
    if (auto ok = check(latlong, options, reference); !ok) return ok.error();
    const Error cancelled{"cancelled", "", ""};
    const ReferenceSource source(latlong);
    Report report(options.progress, all_texels(options));
    FilterResult result;
    for (const LevelSpec& level : options.specular) {
        Grid grid(options.layout, level.size);
        if (level.mirror ? !fill_mirror(grid, source, options, report)
                         : !fill(grid, latlong, source, level.kernel, options, reference, report))
            return cancelled;
        result.specular.push_back(grid.take());
    }
    if (options.irradiance_size > 0) {
        Grid grid(options.layout, options.irradiance_size);
        if (!fill(grid, latlong, source, ZonalKernel::cosine(), options, reference, report)) return cancelled;
        result.irradiance_over_pi = grid.take();
    }
    if (options.sh_bands > 0)
        result.sh = source.spherical_harmonics(options.sh_bands, options.world_to_source, options.threads);
    result.mean = source.mean();
    return result;
}

}  // namespace domelight
