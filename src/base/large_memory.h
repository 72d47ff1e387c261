#pragma once

namespace domelight {

/// While an object of this class exists, large arrays (allocate_large) that are freed are kept for the next allocations,
/// up to 64 MB of them: the system clears every page that it hands out, which takes as long as much of the work on it.
/// The memory returns to the system with the last object.
class LargeMemoryReuse {
  public:
    LargeMemoryReuse();
    ~LargeMemoryReuse();
    LargeMemoryReuse(const LargeMemoryReuse&) = delete;
    LargeMemoryReuse& operator=(const LargeMemoryReuse&) = delete;
};

}  // namespace domelight
