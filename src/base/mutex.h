#pragma once

#ifndef DOMELIGHT_ONE_THREAD
#include <mutex>
#endif

namespace domelight {

#ifdef DOMELIGHT_ONE_THREAD

/// A system without threads (WebAssembly) needs no mutual exclusion, and its standard library has none.
struct Mutex {};
class Lock {
  public:
    explicit Lock(Mutex&) {}
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
};

#else

using Mutex = std::mutex;
using Lock = std::lock_guard<std::mutex>;

#endif

}  // namespace domelight
