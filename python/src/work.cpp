#include "work.h"


#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace domelight::python {
namespace {

/// How often the calling thread looks for signals.
constexpr std::chrono::milliseconds k_signal_interval{50};

/// What the thread that works and the one that waits tell each other.
class Conversation {
  public:
    Progress reporter() {
        return [this](std::string_view stage, double done) {
            {
                const std::lock_guard lock(mutex_);
                stage_ = stage;
                done_ = done;
                told_ = false;
            }
            changed_.notify_one();
            return !cancelled_.load(std::memory_order_relaxed);
        };
    }
    void cancel() { cancelled_ = true; }
    void finish(std::exception_ptr failure) {
        {
            const std::lock_guard lock(mutex_);
            failure_ = std::move(failure);
            finished_ = true;
        }
        changed_.notify_one();
    }
    const std::exception_ptr& failure() const { return failure_; }

    struct News {
        std::optional<std::pair<std::string, double>> progress;
        bool finished = false;
    };
    /// Waits for something new, or for the time to look for signals.
    News wait(bool wants_progress) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, k_signal_interval, [&] { return finished_ || (wants_progress && !told_); });
        News news;
        news.finished = finished_;
        if (!told_) news.progress = {stage_, done_};
        told_ = true;
        return news;
    }

  private:
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
        if (news.progress && !progress.is_none() && !tell(progress, *news.progress)) conversation.cancel();
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    } catch (...) {
        raised = std::current_exception();
        conversation.cancel();
    }
}

}  // namespace

void run_work(const nb::object& progress, const std::function<void(const Progress&)>& work) {
    Conversation conversation;
    std::exception_ptr raised;
    std::thread worker([&] {
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
            news = conversation.wait(!progress.is_none());
        }
        attend(conversation, progress, news, raised);
        finished = news.finished;
    }
    {
        const nb::gil_scoped_release release;
        worker.join();
    }
    if (raised) std::rethrow_exception(raised);
    if (conversation.failure()) std::rethrow_exception(conversation.failure());
}

}  // namespace domelight::python
