#pragma once

#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace domelight {

/// An array of trivial values on a 64-byte boundary, as the SIMD kernels want it. Moves, does not copy. Zeroed unless asked otherwise.
template <typename T>
class AlignedArray {
    static_assert(std::is_trivial_v<T>);

  public:
    AlignedArray() = default;
    explicit AlignedArray(std::size_t count, bool zeroed = true) : size_(count) {
        const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
        data_.reset(static_cast<T*>(std::aligned_alloc(64, bytes ? bytes : 64)));
        if (!data_) throw std::bad_alloc();
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
    std::size_t size_ = 0;
};

}  // namespace domelight
