#include "domelight/parallel.h"

#include <algorithm>
#include <atomic>
#include <sched.h>
#include <thread>
#include <vector>

namespace domelight {

int resolve_threads(int threads) {
    if (threads > 0) return threads;
    // hardware_concurrency ignores the affinity mask that containers and taskset set.
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
    return std::max(1u, std::thread::hardware_concurrency());
}

void parallel_for(int count, int threads, const std::function<void(int)>& task) {
    const int workers = std::min(resolve_threads(threads), count);
    if (workers <= 1) {
        for (int i = 0; i < count; ++i) task(i);
        return;
    }
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(i);
    };
    std::vector<std::jthread> pool;
    pool.reserve(workers - 1);
    for (int t = 1; t < workers; ++t) pool.emplace_back(work);
    work();
}

void parallel_ranges(int count, int grain, int threads, const std::function<void(int, int)>& task) {
    const int pieces = (count + grain - 1) / grain;
    parallel_for(pieces, threads, [&](int p) { task(p * grain, std::min(count, (p + 1) * grain)); });
}

}  // namespace domelight
