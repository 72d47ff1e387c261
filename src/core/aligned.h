#pragma once

#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace domelight {

/// An array of trivial values on a 64-byte boundary, as the SIMD kernels want it. Moves, does not copy. Zeroed unless asked otherwise.
template <typename T>
class AlignedArray {
    static_assert(std::is_trivial_v<T>);

  public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t count, bool zeroed = true) : size_(count) {
        // Large arrays on huge pages where the system has them: touching 50 MB for the first time in 4 KB steps costs as much as filling it.
        const std::size_t bytes = count * sizeof(T), boundary = bytes >= k_huge_page ? k_huge_page : 64;
        const std::size_t rounded = (bytes + boundary - 1) / boundary * boundary;
        data_.reset(static_cast<T*>(std::aligned_alloc(boundary, rounded ? rounded : boundary)));
        if (!data_) throw std::bad_alloc();
#ifdef __linux__
        if (boundary == k_huge_page) madvise(data_.get(), rounded, MADV_HUGEPAGE);
#endif
        if (zeroed) fill_zero();
    }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    void fill_zero() {
        for (std::size_t i = 0; i < size_; ++i) data_.get()[i] = T{};
    }

  private:
    struct Free {
        void operator()(T* p) const { std::free(p); }
    };
    std::unique_ptr<T, Free> data_;
    static constexpr std::size_t k_huge_page = std::size_t(2) << 20;
    std::size_t size_ = 0;
};

}  // namespace domelight
