#include "domelight/capture/capture.h"

#include "domelight/base/parallel.h"
#include "domelight/base/random.h"

#include "base/field_place.h"
#include "render/path_tracer.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

namespace domelight {
namespace {

Result<void> check(const CaptureOptions& o) {
    const struct {
        const char* field;
        double value, low, high;
    } ranges[] = {{"size", double(o.size), 8, 1024},
                  {"samples", double(o.samples), 1, 1 << 20},
                  {"noise", o.noise, 0, 1},
                  {"most_samples", double(o.most_samples), 1, 1 << 20},
                  {"bounces", double(o.bounces), 0, 1000}};
    for (const auto& r : ranges)
        if (!(r.value >= r.low && r.value <= r.high))
            return Error{fmt::format("{:g} is not from {:g} to {:g}", r.value, r.low, r.high), field_place(r.field),
                         ""};
    return {};
}

RenderOptions render_options(const CaptureOptions& o, const Vec3f& position, int number) {
    RenderOptions r;
    r.width = o.size;
    r.height = 6 * o.size;
    r.camera.panorama = Camera::Panorama::cube;
    r.camera.to_world.translation = position;
    r.bounces = o.bounces;
    r.environment_lights = o.environment_lights;
    r.seed = derive_key(o.seed, std::uint64_t(number));
    return r;
}

/// The part of a cube that is traced in one go: its sums are dropped as soon as the texels are known.
class CubeTile {
  public:
    CubeTile(int size, int x0, int y0)
        : x0_(x0),
          y0_(y0),
          columns_(std::min(k_tile, size - x0)),
          rows_(std::min(k_tile, 6 * size - y0)),
          sums_(std::size_t(columns_) * rows_) {}

    /// Returns the number of rays.
    std::int64_t trace(const TileTracer& tracer, const CaptureOptions& o) {
        std::vector<int> wanted(sums_.size(), o.samples);
        std::int64_t rays = tracer.trace(x0_, y0_, columns_, wanted, sums_);
        for (int round = 0; o.noise > 0 && round < 24; ++round) {
            bool any = false;
            for (std::size_t i = 0; i < sums_.size(); ++i) {
                const int count = sums_[i].count;
                const bool more = count < o.most_samples && noise_about(int(i)) > o.noise;
                wanted[i] = more ? std::min(count, o.most_samples - count) : 0;
                any |= more;
            }
            if (!any) break;
            rays += tracer.trace(x0_, y0_, columns_, wanted, sums_);
        }
        return rays;
    }

    void store(CapturedCube& cube) const {
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x) {
                const PixelSums& s = sums_[std::size_t(y) * columns_ + x];
                const Vec3f light(s.radiance / double(s.count));
                float* p = cube.radiance.strip().at(x0_ + x, y0_ + y);
                p[0] = light.x, p[1] = light.y, p[2] = light.z;
                *cube.depth.strip().at(x0_ + x, y0_ + y) = s.covered > 0 ? float(s.depth / s.covered) : 0;
                *cube.coverage.strip().at(x0_ + x, y0_ + y) = s.covered / float(s.count);
            }
    }

    std::int64_t non_finite() const {
        std::int64_t count = 0;
        for (const PixelSums& s : sums_) count += s.non_finite;
        return count;
    }

  private:
    /// A texel's own estimate may be too low by chance: the largest of its own and its neighbours' in the tile.
    double noise_about(int i) const {
        double most = 0;
        const int x = i % columns_, y = i / columns_;
        for (int v = std::max(0, y - 1); v <= std::min(rows_ - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(columns_ - 1, x + 1); ++u)
                most = std::max(most, sums_[std::size_t(v) * columns_ + u].noise());
        return most;
    }

    int x0_, y0_, columns_, rows_;
    std::vector<PixelSums> sums_;
};

/// A few probes that are traced together, so that all threads have work to the end of the batch.
class Batch {
  public:
    Batch(const RayScene& scene, const EnvironmentSampler& sampler, std::span<const Vec3f> positions,
          std::span<const int> numbers, const CaptureOptions& o)
        : options_(o), views_(positions.size()), cubes_(positions.size()), counts_(positions.size()) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            views_[i] = render_options(o, positions[i], numbers[i]);
            tracers_.push_back(make_path_tracer(scene, sampler, views_[i]));
            cubes_[i].radiance = Cubemap(o.size);
            cubes_[i].depth = Cubemap(o.size, 1);
            cubes_[i].coverage = Cubemap(o.size, 1);
        }
    }

    int tasks() const { return int(cubes_.size()) * tiles(); }
    void trace(int task) {
        const int probe = task / tiles(), tile = task % tiles();
        CubeTile part(options_.size, tile % across() * k_tile, tile / across() * k_tile);
        const std::int64_t rays = part.trace(*tracers_[std::size_t(probe)], options_);
        part.store(cubes_[std::size_t(probe)]);
        counts_[std::size_t(probe)].rays += rays;
        counts_[std::size_t(probe)].non_finite += part.non_finite();
    }
    CapturedCube take(int probe) {
        CapturedCube cube = std::move(cubes_[std::size_t(probe)]);
        cube.rays = counts_[std::size_t(probe)].rays;
        cube.non_finite_samples = counts_[std::size_t(probe)].non_finite;
        return cube;
    }

  private:
    struct Counts {
        std::atomic<std::int64_t> rays{0}, non_finite{0};
    };
    int across() const { return (options_.size + k_tile - 1) / k_tile; }
    int tiles() const { return across() * ((6 * options_.size + k_tile - 1) / k_tile); }

    const CaptureOptions& options_;
    std::vector<RenderOptions> views_;  ///< the tracers keep references to them
    std::vector<std::unique_ptr<TileTracer>> tracers_;
    std::vector<CapturedCube> cubes_;
    std::vector<Counts> counts_;
};

/// Counts what is done, from several threads.
class Steps {
  public:
    Steps(const Progress& progress, double all) : progress_(progress), all_(all) {}
    void add(double part) {
        if (!progress_) return;
        const std::lock_guard lock(mutex_);
        done_ += part;
        if (!progress_("capture", std::min(1.0, done_ / all_))) cancelled_ = true;
    }
    bool cancelled() const { return cancelled_; }

  private:
    const Progress& progress_;
    std::mutex mutex_;
    double all_, done_ = 0;
    std::atomic<bool> cancelled_{false};
};

}  // namespace

Result<void> capture(const RayScene& scene, const EnvironmentSampler& sampler, std::span<const Vec3f> positions,
                     std::span<const int> numbers, const CaptureOptions& options,
                     const std::function<Result<void>(int index, CapturedCube cube)>& use) {
    if (auto ok = check(options); !ok) return ok;
    const int count = int(positions.size()), at_once = 2 * resolve_threads(options.threads);
    Steps steps(options.progress, count);
    std::mutex mutex;
    std::optional<Error> failed;
    for (int first = 0; first < count && !steps.cancelled() && !failed; first += at_once) {
        const std::size_t n = std::size_t(std::min(at_once, count - first));
        Batch batch(scene, sampler, positions.subspan(std::size_t(first), n), numbers.subspan(std::size_t(first), n),
                    options);
        parallel_for(batch.tasks(), options.threads, [&](int task) {
            if (steps.cancelled()) return;
            batch.trace(task);
            steps.add(double(n) / batch.tasks());
        });
        if (steps.cancelled()) break;
        parallel_for(int(n), options.threads, [&](int i) {
            if (auto ok = use(first + i, batch.take(i)); !ok) {
                const std::lock_guard lock(mutex);
                if (!failed) failed = ok.error();
            }
        });
    }
    if (steps.cancelled()) return Error{"cancelled", "", ""};
    if (failed) return *failed;
    return {};
}

}  // namespace domelight
