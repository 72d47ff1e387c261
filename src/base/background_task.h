#pragma once
// Work in another thread, whose result is asked for later.

#ifdef DOMELIGHT_ONE_THREAD
#include <optional>
#else
#include <future>
#endif

#include <utility>

namespace domelight {

#ifdef DOMELIGHT_ONE_THREAD

/// A system without threads (WebAssembly) does the work at once, and its standard library has no std::future.
template <typename T>
class BackgroundTask {
  public:
    BackgroundTask() = default;
    explicit BackgroundTask(T result) : result_(std::move(result)) {}
    bool valid() const { return result_.has_value(); }
    T get() { return *std::exchange(result_, std::nullopt); }

  private:
    std::optional<T> result_;
};

template <typename T, typename Work>
BackgroundTask<T> in_background(Work&& work) {
    return BackgroundTask<T>(work());
}
template <typename T>
BackgroundTask<T> finished_task(T result) {
    return BackgroundTask<T>(std::move(result));
}

#else

template <typename T>
using BackgroundTask = std::future<T>;

/// Starts `work`, which returns a T. Where no thread can be started, it is done when its result is asked for.
template <typename T, typename Work>
BackgroundTask<T> in_background(Work&& work) {
    return std::async(std::launch::async | std::launch::deferred, std::forward<Work>(work));
}
/// A task that is done already.
template <typename T>
BackgroundTask<T> finished_task(T result) {
    std::promise<T> promise;
    auto task = promise.get_future();
    promise.set_value(std::move(result));
    return task;
}

#endif

}  // namespace domelight
