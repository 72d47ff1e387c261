#include "domelight/base/large_allocator.h"

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
#endif

namespace domelight {

#ifdef DOMELIGHT_PLAIN_MEMORY

const bool k_large_is_zero = false;

void* allocate_large(std::size_t bytes) {
    return ::operator new(bytes, std::align_val_t(64));
}
void free_large(void* memory, std::size_t) noexcept {
    ::operator delete(memory, std::align_val_t(64));
}

#else

const bool k_large_is_zero = true;

namespace {

constexpr std::size_t k_huge_page = std::size_t(2) << 20;

std::size_t round_up(std::size_t bytes) {
    return (bytes + 4095) / 4096 * 4096;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
    // One huge page more than asked for, so that the start can be aligned to its boundary.
    const std::size_t size = round_up(bytes), room = size + k_huge_page;
    if (room < bytes) throw std::bad_alloc();
    void* start = ::mmap(nullptr, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) throw std::bad_alloc();
    char* const first = static_cast<char*>(start);
    const std::size_t skip = (k_huge_page - reinterpret_cast<std::uintptr_t>(first) % k_huge_page) % k_huge_page;
    if (skip > 0) ::munmap(first, skip);
    if (k_huge_page > skip) ::munmap(first + skip + size, k_huge_page - skip);
    ::madvise(first + skip, size, MADV_HUGEPAGE);  // only a hint: if it is refused, small pages are used
    return first + skip;
}

void free_large(void* memory, std::size_t bytes) noexcept {
    ::munmap(memory, round_up(bytes));
}

#endif

}  // namespace domelight
