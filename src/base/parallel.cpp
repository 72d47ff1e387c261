#include "domelight/base/parallel.h"

#include <algorithm>

#ifndef DOMELIGHT_ONE_THREAD
#include <sched.h>

#include <atomic>
#include <exception>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>
#endif

namespace domelight {

#ifdef DOMELIGHT_ONE_THREAD

int resolve_threads(int) {
    return 1;
}

void parallel_for(int count, int, const std::function<void(int)>& task) {
    for (int i = 0; i < count; ++i) task(i);
}

#else

namespace {

/// A thread that runs one piece of work after the other and sleeps in between. Starting a thread takes about 50 us, and
/// a bake has hundreds of parallel loops.
class Helper {
  public:
    Helper() : thread_([this] { serve(); }) {}
    ~Helper() {
        state_.store(k_stop);
        state_.notify_one();
    }
    Helper(const Helper&) = delete;
    Helper& operator=(const Helper&) = delete;

    /// Starts `work()`, which must exist until finish() returns.
    void start(const std::function<void()>& work) {
        work_ = &work;
        state_.store(k_asked, std::memory_order_release);
        state_.notify_one();
    }
    /// Waits for the end of the work; work that has not begun is cancelled (the other threads have done all of it by
    /// then).
    void finish() {
        int asked = k_asked;
        if (state_.compare_exchange_strong(asked, k_idle)) return;
        while (state_.load(std::memory_order_acquire) == k_busy) state_.wait(k_busy);
    }

  private:
    enum State : int { k_idle, k_asked, k_busy, k_stop };

    void serve() {
        for (;;) {
            int state = state_.load(std::memory_order_acquire);
            if (state == k_stop) return;
            if (state == k_idle) {
                state_.wait(k_idle);
            } else if (state_.compare_exchange_strong(state, k_busy)) {
                (*work_)();
                state_.store(k_idle, std::memory_order_release);
                state_.notify_one();
            }
        }
    }

    std::atomic<int> state_{k_idle};
    const std::function<void()>* work_ = nullptr;
    std::jthread thread_;  // the last member: it uses the others, and its end is awaited first
};

/// The helpers of one thread that calls parallel_for. Each caller has its own, so calls from several threads do not
/// interfere.
std::vector<std::unique_ptr<Helper>>& helpers_of_this_thread() {
    thread_local std::vector<std::unique_ptr<Helper>> helpers;
    return helpers;
}

/// Whether this thread is inside a parallel loop. An inner loop runs on this thread alone, because its helpers are
/// busy.
thread_local bool t_inside = false;

}  // namespace

int resolve_threads(int threads) {
    if (threads > 0) return threads;
    // hardware_concurrency ignores the affinity mask that containers and taskset set.
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
    return std::max(1u, std::thread::hardware_concurrency());
}

void parallel_for(int count, int threads, const std::function<void(int)>& task) {
    const int workers = std::min(resolve_threads(threads), count);
    if (workers <= 1 || t_inside) {
        for (int i = 0; i < count; ++i) task(i);
        return;
    }
    std::atomic<int> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;  // written by the thread that sets `failed`
    const std::function<void()> work = [&] {
        t_inside = true;
        try {
            for (int i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(i);
        } catch (...) {
            if (!failed.exchange(true)) failure = std::current_exception();
            next.store(count, std::memory_order_relaxed);
        }
        t_inside = false;
    };
    auto& helpers = helpers_of_this_thread();
    try {
        while (int(helpers.size()) < workers - 1) helpers.push_back(std::make_unique<Helper>());
    } catch (const std::system_error&) {
        // The system starts no more threads: those that there are do the work.
    }
    const std::size_t started = std::min(helpers.size(), std::size_t(workers - 1));
    for (std::size_t t = 0; t < started; ++t) helpers[t]->start(work);
    work();
    for (std::size_t t = 0; t < started; ++t) helpers[t]->finish();
    if (failure) std::rethrow_exception(failure);
}

#endif

void parallel_ranges(int count, int grain, int threads, const std::function<void(int, int)>& task) {
    const int pieces = (count + grain - 1) / grain;
    parallel_for(pieces, threads, [&](int p) { task(p * grain, std::min(count, (p + 1) * grain)); });
}

}  // namespace domelight
