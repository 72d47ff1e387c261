#include "domelight/parallel.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace domelight {
namespace {

/// Takes the next item until none is left.
struct Work {
    int count;
    const std::function<void(int)>& task;
    std::atomic<int> next{0};

    void run() {
        for (int i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(i);
    }
};

/// Threads that wait for work: starting one takes as long as a row of an image. It serves one caller at a time.
class Pool {
  public:
    /// Runs `work` on the calling thread and `helpers` of the pool's.
    void run(Work& work, int helpers) {
        {
            const std::lock_guard lock(mutex_);
            while (int(threads_.size()) < helpers) threads_.emplace_back([this] { serve(); });
            work_ = &work;
            wanted_ = helpers;
        }
        for (int i = 0; i < helpers; ++i) wake_.notify_one();
        work.run();
        std::unique_lock lock(mutex_);
        // Those that have not woken by now need not.
        wanted_ = 0;
        done_.wait(lock, [this] { return working_ == 0; });
        work_ = nullptr;
    }

  private:
    void serve() {
        std::unique_lock lock(mutex_);
        for (;;) {
            wake_.wait(lock, [this] { return wanted_ > 0; });
            --wanted_;
            ++working_;
            Work& work = *work_;
            lock.unlock();
            work.run();
            lock.lock();
            if (--working_ == 0) done_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_, done_;
    std::vector<std::thread> threads_;
    Work* work_ = nullptr;
    int wanted_ = 0, working_ = 0;
};

/// The process's pool, for who comes first; none while somebody uses it.
class PoolLease {
  public:
    PoolLease() {
        if (taken().test_and_set(std::memory_order_acquire)) return;
        static Pool* pool = nullptr;
        static pid_t owner = 0;
        // A forked child has its parent's pool but none of its threads. The threads of a process end with it: the
        // pool is never destroyed.
        if (owner != getpid()) pool = new Pool, owner = getpid();
        pool_ = pool;
    }
    ~PoolLease() {
        if (pool_) taken().clear(std::memory_order_release);
    }
    PoolLease(const PoolLease&) = delete;
    PoolLease& operator=(const PoolLease&) = delete;
    Pool* operator->() const { return pool_; }
    explicit operator bool() const { return pool_; }

  private:
    static std::atomic_flag& taken() {
        static std::atomic_flag flag;
        return flag;
    }
    Pool* pool_ = nullptr;
};

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
    Work work{count, task};
    if (workers <= 1) {
        work.run();
    } else if (const PoolLease pool; pool) {
        pool->run(work, workers - 1);
    } else {
        std::vector<std::jthread> own;
        for (int t = 1; t < workers; ++t) own.emplace_back([&] { work.run(); });
        work.run();
    }
}

void parallel_ranges(int count, int grain, int threads, const std::function<void(int, int)>& task) {
    const int pieces = (count + grain - 1) / grain;
    parallel_for(pieces, threads, [&](int p) { task(p * grain, std::min(count, (p + 1) * grain)); });
}

}  // namespace domelight
