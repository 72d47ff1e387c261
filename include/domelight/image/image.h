#pragma once

#include "domelight/base/large_allocator.h"

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace domelight {

/// A non-owning view of pixels: interleaved channels, rows top to bottom. T may be const.
template <typename T>
struct ImageView {
    T* data = nullptr;
    int width = 0;
    int height = 0;
    int channels = 0;
    std::ptrdiff_t stride = 0;  ///< elements from one row to the next

    ImageView() = default;
    ImageView(T* data_, int width_, int height_, int channels_, std::ptrdiff_t stride_ = 0)
        : data(data_),
          width(width_),
          height(height_),
          channels(channels_),
          stride(stride_ ? stride_ : std::ptrdiff_t(width_) * channels_) {}
    /// A mutable view is also a const one.
    template <typename U>
    requires std::is_same_v<T, const U> ImageView(const ImageView<U>& v)
        : ImageView(v.data, v.width, v.height, v.channels, v.stride) {}

    T* row(int y) const {
        assert(y >= 0 && y < height);
        return data + y * stride;
    }
    T* at(int x, int y) const {
        assert(x >= 0 && x < width);
        return row(y) + std::ptrdiff_t(x) * channels;
    }
    /// Rows first .. first + count - 1 of the same pixels.
    ImageView rows(int first, int count) const {
        assert(first >= 0 && count >= 0 && first + count <= height);
        return {data + first * stride, width, count, channels, stride};
    }
};

/// Pixels that this object owns, without gaps between rows.
template <typename T>
class Image {
  public:
    Image() = default;
    Image(int width, int height, int channels, T value = {})
        : width_(width), height_(height), channels_(channels), data_(std::size_t(width) * height * channels, value) {}
    /// Uninitialised pixels: the caller must write every one. The memory is first touched by the threads that write it.
    static Image uninitialized(int width, int height, int channels) {
        Image image;
        image.width_ = width;
        image.height_ = height;
        image.channels_ = channels;
        image.data_ = decltype(image.data_)(std::size_t(width) * height * channels);
        return image;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool empty() const { return data_.empty(); }
    std::span<T> pixels() { return data_; }
    std::span<const T> pixels() const { return data_; }
    T* row(int y) { return view().row(y); }
    const T* row(int y) const { return view().row(y); }
    T* at(int x, int y) { return view().at(x, y); }
    const T* at(int x, int y) const { return view().at(x, y); }

    ImageView<T> view() { return {data_.data(), width_, height_, channels_}; }
    ImageView<const T> view() const { return {data_.data(), width_, height_, channels_}; }
    operator ImageView<T>() { return view(); }
    operator ImageView<const T>() const { return view(); }

  private:
    int width_ = 0, height_ = 0, channels_ = 0;
    std::vector<T, LargeAllocator<T>> data_;
};

using ImageF = Image<float>;

/// Six square faces +X -X +Y -Y +Z -Z in OpenGL's orientation (docs/conventions.md), RGB float radiance unless said
/// otherwise.
class Cubemap {
  public:
    Cubemap() = default;
    explicit Cubemap(int size, int channels = 3) : faces_(size, 6 * size, channels) {}
    /// From a strip, size x 6 size.
    explicit Cubemap(Image<float> strip) : faces_(std::move(strip)) { assert(faces_.height() == 6 * faces_.width()); }

    int size() const { return faces_.width(); }
    int channels() const { return faces_.channels(); }
    bool empty() const { return faces_.empty(); }
    ImageView<float> face(int f) { return faces_.view().rows(f * size(), size()); }
    ImageView<const float> face(int f) const { return faces_.view().rows(f * size(), size()); }
    /// The faces one below the other: size x 6 size.
    ImageView<float> strip() { return faces_.view(); }
    ImageView<const float> strip() const { return faces_.view(); }
    std::span<float> pixels() { return faces_.pixels(); }
    std::span<const float> pixels() const { return faces_.pixels(); }
    /// The pixels themselves, moved out of a cube that is no longer needed: size x 6 size.
    ImageF take_strip() && { return std::move(faces_); }

  private:
    ImageF faces_;
};

}  // namespace domelight
