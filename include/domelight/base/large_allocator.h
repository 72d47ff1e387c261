#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace domelight {

/// Memory for large arrays, taken from the system directly, in large pages where the system has them. A 64 MB array in
/// 4 KB pages costs 16384 page faults, which take longer than filling it. Free it with the same size. The contents
/// are undefined. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;

/// An allocator for pixels. Large arrays come from allocate_large. Elements without a given value stay uninitialised:
/// their values are undefined.
template <typename T>
struct LargeAllocator {
    using value_type = T;
    /// Arrays of this size or more count as large.
    static constexpr std::size_t k_large_bytes = std::size_t(4) << 20;

    LargeAllocator() = default;
    template <typename U>
    LargeAllocator(const LargeAllocator<U>&) {}

    T* allocate(std::size_t n) {
        if (n > std::size_t(-1) / sizeof(T)) throw std::bad_array_new_length();
        if (n * sizeof(T) < k_large_bytes) return std::allocator<T>().allocate(n);
        return static_cast<T*>(allocate_large(n * sizeof(T)));
    }
    void deallocate(T* memory, std::size_t n) noexcept {
        if (n * sizeof(T) < k_large_bytes)
            std::allocator<T>().deallocate(memory, n);
        else
            free_large(memory, n * sizeof(T));
    }
    template <typename U>
    void construct(U* place) noexcept {
        ::new (static_cast<void*>(place)) U;
    }
    template <typename U, typename... Args>
    void construct(U* place, Args&&... args) {
        ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
    }
    friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

}  // namespace domelight
