#include "work.h"

#include <unistd.h>


#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace domelight::python {
namespace {

/// How often the calling thread looks for signals.
constexpr std::chrono::milliseconds k_signal_interval{50};

/// What the thread that works and the one that waits tell each other.
class Conversation {
  public:
    explicit Conversation(bool wants_progress) : wants_progress_(wants_progress) {}
    Progress reporter() {
        return [this](std::string_view stage, double done) {
            if (wants_progress_) {
                const std::lock_guard lock(mutex_);
                stage_ = stage;
                done_ = done;
                told_ = false;
                changed_.notify_one();
            }
            return !cancelled_.load(std::memory_order_relaxed);
        };
    }
    void cancel() { cancelled_ = true; }
    void finish(std::exception_ptr failure) {
        // Notified under the lock: the one who waits may destroy this object as soon as it has the lock.
        const std::lock_guard lock(mutex_);
        failure_ = std::move(failure);
        finished_ = true;
        changed_.notify_one();
    }
    const std::exception_ptr& failure() const { return failure_; }

    struct News {
        std::optional<std::pair<std::string, double>> progress;
        bool finished = false;
    };
    /// Waits for something new, or for the time to look for signals.
    News wait() {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, k_signal_interval, [&] { return finished_ || !told_; });
        News news;
        news.finished = finished_;
        if (!told_) news.progress = {stage_, done_};
        told_ = true;
        return news;
    }

  private:
    const bool wants_progress_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string stage_;
    double done_ = 0;
    bool told_ = true, finished_ = false;
    std::exception_ptr failure_;
    std::atomic<bool> cancelled_{false};
};

/// Calls the callback; false if it asks to stop.
bool tell(const nb::object& progress, const std::pair<std::string, double>& news) {
    const nb::object answer = progress(news.first, news.second);
    return answer.ptr() != Py_False;
}

/// One look of the calling thread: passes progress on and handles signals. Where Python code raises, the exception is
/// kept for later and the work is cancelled.
void attend(Conversation& conversation, const nb::object& progress, const Conversation::News& news,
            std::exception_ptr& raised) {
    if (raised) return;
    try {
        if (news.progress && !tell(progress, *news.progress)) conversation.cancel();
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    } catch (...) {
        raised = std::current_exception();
        conversation.cancel();
    }
}

/// A thread that does one piece of work after the other. It is kept, because the memory that a new thread works in would
/// have to be cleared by the system each time, which takes a tenth of the time of a small filter.
class Worker {
  public:
    Worker() : thread_([this] { serve(); }) {}
    ~Worker() {
        post({});
        thread_.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// No job: the thread ends.
    void post(std::function<void()> job) {
        const std::lock_guard lock(mutex_);
        job_ = std::move(job);
        posted_ = true;
        changed_.notify_one();
    }
    /// False in a child process made by fork(), which has no such thread.
    bool alive() const { return process_ == ::getpid(); }

  private:
    void serve() {
        for (;;) {
            std::function<void()> job;
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] { return posted_; });
                posted_ = false;
                job = std::move(job_);
            }
            if (!job) return;
            job();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::function<void()> job_;
    bool posted_ = false;
    const pid_t process_ = ::getpid();
    std::thread thread_;  // the last member: it uses the others
};

/// The idle workers of one calling thread. A callback may call the library while work goes on: then there are two.
class IdleWorkers {
  public:
    ~IdleWorkers() { drop_dead(); }
    std::unique_ptr<Worker> take() {
        drop_dead();
        if (workers_.empty()) return std::make_unique<Worker>();
        auto worker = std::move(workers_.back());
        workers_.pop_back();
        return worker;
    }
    void put(std::unique_ptr<Worker> worker) { workers_.push_back(std::move(worker)); }

  private:
    /// In a child process the threads do not exist: their objects are left as they are.
    void drop_dead() {
        for (auto& worker : workers_)
            if (!worker->alive()) (void)worker.release();
        std::erase(workers_, nullptr);
    }
    std::vector<std::unique_ptr<Worker>> workers_;
};

IdleWorkers& idle_workers() {
    thread_local IdleWorkers workers;
    return workers;
}

}  // namespace

void run_work(const nb::object& progress, const std::function<void(const Progress&)>& work) {
    Conversation conversation(!progress.is_none());
    std::exception_ptr raised;
    auto worker = idle_workers().take();
    worker->post([&] {
        std::exception_ptr failure;
        try {
            work(conversation.reporter());
        } catch (...) {
            failure = std::current_exception();
        }
        conversation.finish(std::move(failure));
    });
    for (bool finished = false; !finished;) {
        Conversation::News news;
        {
            const nb::gil_scoped_release release;
            news = conversation.wait();
        }
        attend(conversation, progress, news, raised);
        finished = news.finished;
    }
    idle_workers().put(std::move(worker));
    if (raised) std::rethrow_exception(raised);
    if (conversation.failure()) std::rethrow_exception(conversation.failure());
}

}  // namespace domelight::python
