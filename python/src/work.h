#pragma once
// Long work of the library, called from Python.

#include "domelight/base/progress.h"

#include "errors.h"

#include <functional>
#include <optional>
#include <utility>

namespace domelight::python {

/// Runs `work` on another thread without the interpreter's lock, and returns when it is done. The calling thread
/// meanwhile passes its progress on to `progress(stage, done)` (None: to nobody) and looks for signals. Where the
/// callback raises or returns False, or a signal's handler raises (Ctrl-C), the work is asked to stop, and what was
/// raised is raised here once it has stopped. A child process made by fork() can call the library too: its work runs on
/// new threads.
void run_work(const nb::object& progress, const std::function<void(const Progress&)>& work);

/// The same for work that gives a result.
template <typename F>
auto run_work_for(const nb::object& progress, F&& work) {
    using Value = decltype(work(std::declval<const Progress&>()));
    std::optional<Value> result;
    run_work(progress, [&](const Progress& report) { result.emplace(work(report)); });
    return *std::move(result);
}

}  // namespace domelight::python
