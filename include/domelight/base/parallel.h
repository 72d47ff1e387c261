#pragma once

#include <functional>

namespace domelight {

/// The number of threads to use when `threads` are asked for: 0 means every core that the process may run on. At least
/// 1.
int resolve_threads(int threads);

/// Calls `task(i)` once for each i in [0, count), on up to `threads` threads (0: all), in no particular order; returns
/// when all are done.
///
/// What a task computes must depend on `i` alone and be stored in a place of its own, so that the result has the same
/// bits on any number of threads. The caller adds up sums over tasks, in order of i. Calls must not be nested.
void parallel_for(int count, int threads, const std::function<void(int)>& task);

/// The same over ranges: `task(begin, end)` for consecutive pieces of [0, count) of `grain` items (the last may be
/// shorter). Piece boundaries do not depend on the number of threads.
void parallel_ranges(int count, int grain, int threads, const std::function<void(int begin, int end)>& task);

}  // namespace domelight
