#include "domelight/base/large_allocator.h"

#include "base/large_memory.h"

#include <cstdint>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DOMELIGHT_PLAIN_MEMORY 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || !defined(__linux__)
#define DOMELIGHT_PLAIN_MEMORY 1  // the sanitizer only checks memory that it has allocated itself
#endif

#ifndef DOMELIGHT_PLAIN_MEMORY
#include <sys/mman.h>

#include <algorithm>
#include <mutex>
#include <unordered_map>
#include <vector>
#endif

namespace domelight {

#ifdef DOMELIGHT_PLAIN_MEMORY

void* allocate_large(std::size_t bytes) {
    return ::operator new(bytes, std::align_val_t(64));
}
void free_large(void* memory, std::size_t) noexcept {
    ::operator delete(memory, std::align_val_t(64));
}
LargeMemoryReuse::LargeMemoryReuse() = default;
LargeMemoryReuse::~LargeMemoryReuse() = default;

#else

namespace {

constexpr std::size_t k_huge_page = std::size_t(2) << 20, k_most_kept = std::size_t(64) << 20;

struct Block {
    void* memory;
    std::size_t size;
};

/// The sizes of all large arrays, and those that are kept for reuse.
struct LargeMemory {
    std::mutex mutex;
    int users = 0;
    std::unordered_map<void*, std::size_t> sizes;  ///< of arrays in use
    std::vector<Block> kept;
    std::size_t kept_bytes = 0;
};

LargeMemory& large_memory() {
    static LargeMemory memory;
    return memory;
}

std::size_t round_up(std::size_t bytes) {
    return (bytes + 4095) / 4096 * 4096;
}

void* map_large(std::size_t size) {
    // One huge page more than asked for, so that the start can be aligned to its boundary.
    const std::size_t room = size + k_huge_page;
    if (room < size) throw std::bad_alloc();
    void* start = ::mmap(nullptr, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) throw std::bad_alloc();
    char* const first = static_cast<char*>(start);
    const std::size_t skip = (k_huge_page - reinterpret_cast<std::uintptr_t>(first) % k_huge_page) % k_huge_page;
    if (skip > 0) ::munmap(first, skip);
    if (k_huge_page > skip) ::munmap(first + skip + size, k_huge_page - skip);
    ::madvise(first + skip, size, MADV_HUGEPAGE);  // only a hint: if it is refused, small pages are used
    return first + skip;
}

/// The smallest block that is kept and large enough, but not four times as large.
Block take_kept(LargeMemory& large, std::size_t size) {
    auto best = large.kept.end();
    for (auto b = large.kept.begin(); b != large.kept.end(); ++b)
        if (b->size >= size && b->size / 4 <= size && (best == large.kept.end() || b->size < best->size)) best = b;
    if (best == large.kept.end()) return {nullptr, 0};
    const Block block = *best;
    large.kept.erase(best);
    large.kept_bytes -= block.size;
    return block;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
    const std::size_t size = round_up(bytes);
    if (size < bytes) throw std::bad_alloc();
    LargeMemory& large = large_memory();
    const std::lock_guard lock(large.mutex);
    const Block kept = take_kept(large, size);
    if (kept.memory) {
        large.sizes[kept.memory] = kept.size;
        return kept.memory;
    }
    void* const memory = map_large(size);
    large.sizes[memory] = size;
    return memory;
}

void free_large(void* memory, std::size_t) noexcept {
    LargeMemory& large = large_memory();
    const std::lock_guard lock(large.mutex);
    const auto found = large.sizes.find(memory);
    const std::size_t size = found->second;
    large.sizes.erase(found);
    if (large.users > 0 && large.kept_bytes + size <= k_most_kept && large.kept.size() < large.kept.capacity()) {
        large.kept.push_back({memory, size});
        large.kept_bytes += size;
    } else {
        ::munmap(memory, size);
    }
}

LargeMemoryReuse::LargeMemoryReuse() {
    LargeMemory& large = large_memory();
    const std::lock_guard lock(large.mutex);
    large.kept.reserve(64);
    ++large.users;
}

LargeMemoryReuse::~LargeMemoryReuse() {
    LargeMemory& large = large_memory();
    const std::lock_guard lock(large.mutex);
    if (--large.users > 0) return;
    for (const Block& block : large.kept) ::munmap(block.memory, block.size);
    large.kept.clear();
    large.kept_bytes = 0;
}

#endif

}  // namespace domelight
