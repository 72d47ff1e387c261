// The reference picture: decides, in rounds, how many samples each pixel gets.

#include "domelight/base/parallel.h"

#include "render/background.h"
#include "render/film.h"
#include "render/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

namespace domelight {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

EnvironmentSamplerOptions reference_sampler_options(LightStrategy strategy, int threads) {
    EnvironmentSamplerOptions options;
    options.method = DistributionMethod::bilinear;
    options.compensate = strategy == LightStrategy::mis;
    options.threads = threads;
    return options;
}

Result<RenderResult> render_reference(const RayScene& scene, const EnvironmentSampler& sampler,
                                      const RenderOptions& o) {
    if (auto fine = check_size(o.width, o.height); !fine) return fine.error();
    if (auto fine = check_background(o); !fine) return fine.error();
    if (o.strategy == LightStrategy::environment && sampler.compensation() > 0)
        return Error{"a sampler with MIS compensation leaves out light that this strategy has no other way to find", "",
                     "Build it with reference_sampler_options(strategy)."};
    const auto start = std::chrono::steady_clock::now();
    const auto tracer = make_path_tracer(scene, sampler, o);
    Film film(o.width, o.height);
    std::atomic<std::int64_t> rays{0};
    std::atomic<bool> cancelled{false};
    std::atomic<int> tiles_done{0};
    std::mutex progress_mutex;

    const auto picture = [&] {
        RenderResult out = develop(film, o.width, o.height);
        out.rays = rays;
        out.seconds = seconds_since(start);
        return out;
    };
    StatusSums status(film);
    int rounds = 0;  // that were completed

    // One round: adds wanted(x, y) samples to each pixel.
    const auto round = [&](const auto& wanted, double from, double to) {
        if (rounds > 0 && o.checkpoint && (!o.checkpoint_wanted || o.checkpoint_wanted())) o.checkpoint(picture());
        tiles_done = 0;
        parallel_for(film.tiles(), o.threads, [&](int t) {
            if (cancelled) return;
            const int columns = film.columns(t);
            std::vector<int> count(film.tile(t).size());
            for (int i = 0; i < int(count.size()); ++i)
                count[i] = wanted(film.x0(t) + i % columns, film.y0(t) + i / columns);
            rays += tracer->trace(film.x0(t), film.y0(t), columns, count, film.tile(t));
            const int done = ++tiles_done;
            if (o.progress) {
                const std::lock_guard lock(progress_mutex);
                if (o.status) o.status(status.after(t, seconds_since(start)));
                if (!o.progress("render", from + (to - from) * done / film.tiles())) cancelled = true;
            }
        });
        if (!cancelled) ++rounds;
    };
    // A round adds at most this many samples, so that `progress` is called often enough; with checkpoints, this is also
    // the most that can be lost.
    const auto longest_round = [&](int total) { return o.checkpoint ? std::clamp(total / 4, 8, 1024) : 1024; };

    if (o.seconds > 0) {
        // Rounds double as long as the next one is likely to end in time.
        int total = 0;
        for (int add = 1; !cancelled; add = std::max(1, total)) {
            const double spent = seconds_since(start), left = o.seconds - spent;
            if (total > 0) {
                if (left <= 0 || total >= o.most_samples) break;
                add = std::min(
                    {add, longest_round(total), o.most_samples - total, std::max(1, int(left / spent * total))});
                if (left < spent / total) break;
            }
            round([&](int, int) { return add; }, std::min(1.0, spent / o.seconds),
                  std::min(1.0, 2 * spent / o.seconds));
            total += add;
        }
    } else {
        const int wanted = std::max(1, o.samples);
        const double end = o.noise > 0 ? 0.3 : 1;
        int total = 0;
        while (!cancelled && total < wanted) {
            const int add = std::min(longest_round(total), wanted - total);
            round([&](int, int) { return add; }, end * total / wanted, end * (total + add) / wanted);
            total += add;
        }
        for (int k = 0; o.noise > 0 && !cancelled && k < 24; ++k) {
            // Decided for all pixels before any is changed.
            ImageF wanted(o.width, o.height, 1);
            bool any = false;
            parallel_ranges(o.height, 8, o.threads, [&](int begin, int end) {
                for (int y = begin; y < end; ++y)
                    for (int x = 0; x < o.width; ++x) {
                        const int count = film.at(x, y).count;
                        if (count < o.most_samples && film.noise_about(x, y) > o.noise)
                            *wanted.at(x, y) = float(std::min(count, o.most_samples - count));
                    }
            });
            for (const float w : wanted.pixels()) any |= w > 0;
            if (!any) break;
            round([&](int x, int y) { return int(*wanted.at(x, y)); }, 0.3 + 0.7 * k / (k + 1.0),
                  0.3 + 0.7 * (k + 1.0) / (k + 2.0));
        }
    }
    if (cancelled) {
        // Every pixel has samples, even though some tiles have more: this is a complete picture.
        if (rounds > 0 && o.checkpoint) o.checkpoint(picture());
        return Error{"cancelled", "", ""};
    }
    return picture();
}

}  // namespace domelight
