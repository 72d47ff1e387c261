#pragma once

#include "domelight/base/large_allocator.h"

#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

namespace domelight {

/// An array of trivial values on a 64-byte boundary, for SIMD kernels. Large arrays are allocated from the system
/// directly, in large pages. It can be moved but not copied, and is zeroed unless asked otherwise.
template <typename T>
class AlignedArray {
    static_assert(std::is_trivial_v<T>);

  public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t count, bool zeroed = true) : size_(count) {
        const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
        const bool large = bytes >= LargeAllocator<T>::k_large_bytes;
        void* memory = large ? allocate_large(bytes) : std::aligned_alloc(64, bytes ? bytes : 64);
        if (!memory) throw std::bad_alloc();
        data_ = {static_cast<T*>(memory), Free{large ? bytes : 0}};
        if (zeroed) std::memset(memory, 0, bytes);
    }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    void fill_zero() { std::memset(data_.get(), 0, size_ * sizeof(T)); }

  private:
    struct Free {
        std::size_t large_bytes = 0;
        void operator()(T* p) const {
            if (large_bytes)
                free_large(p, large_bytes);
            else
                std::free(p);
        }
    };
    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0;
};

}  // namespace domelight
