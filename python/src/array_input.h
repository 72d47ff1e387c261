#pragma once
// Arrays of NumPy, PyTorch, JAX and others as the library reads them.

#include "domelight/base/result.h"
#include "domelight/image/image.h"
#include "domelight/image/row_source.h"

#include "errors.h"

#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace domelight::python {

/// Any array of numbers that is in the CPU's memory; it is only read.
using AnyArray = nb::ndarray<nb::ro>;

/// An array of pixels that stays where it is: rows x columns x channels of float16, float32 or float64, and for pictures
/// also of uint8, with any strides. Copies share it, and may be destroyed by any thread.
class ArrayPixels {
  public:
    enum class Type { half, single, wide, byte };

    /// Borrows the array. Charts (the faces of a cube, an array with one more axis in front) lie one below the other.
    ///
    /// array     any object with a buffer or with __dlpack__
    /// channels  how many it must have; 1 also accepts an array without an axis for channels
    /// keyword   names it in errors
    /// bytes_too also accepts uint8, which copies hold as 0 to 255
    ///
    /// Raises domelight.Error: no array, another type of numbers, another shape, no memory, not in the CPU's memory.
    static ArrayPixels borrow(nb::handle array, int channels, const char* keyword, bool bytes_too = false);

    int width() const { return width_; }
    int height() const { return charts_ * chart_height_; }  ///< of all charts
    int charts() const { return charts_; }                  ///< 1 where the array has no axis of charts
    int chart_height() const { return chart_height_; }
    int channels() const { return channels_; }
    bool has_charts() const { return has_charts_; }
    bool holds_bytes() const { return type_ == Type::byte; }

    /// Whether the rows can be read in place as an ImageView: float32, channels and columns close together, and charts
    /// that follow each other like rows.
    bool viewable() const;
    ImageView<const float> view() const;
    /// Copies rows first .. first + out.height - 1.
    void copy_rows(int first, ImageView<float> out) const;
    /// A copy of all.
    ImageF copy() const;

  private:
    const char* row(int y) const {
        return data_ + (y / chart_height_) * chart_stride_ + (y % chart_height_) * row_stride_;
    }
    std::shared_ptr<const AnyArray> owner_;
    const char* data_ = nullptr;
    Type type_ = Type::single;
    int charts_ = 1, chart_height_ = 0, width_ = 0, channels_ = 3;
    bool has_charts_ = false;
    std::int64_t chart_stride_ = 0, row_stride_ = 0, column_stride_ = 0, channel_stride_ = 0;  // in bytes
};

/// The pixels of an array as radiance: a picture that is viewed in place where possible, else a copy.
class ArrayImage {
  public:
    explicit ArrayImage(ArrayPixels pixels) : pixels_(std::move(pixels)) {
        if (!pixels_.viewable()) copy_ = pixels_.copy();
    }
    ImageView<const float> view() const { return copy_.empty() ? pixels_.view() : copy_.view(); }

  private:
    ArrayPixels pixels_;
    ImageF copy_;
};

/// An error if a value of radiance is NaN, infinite or negative; it names the texel. `first_row`: of the picture.
Result<void> check_radiance(ImageView<const float> rows, int first_row, const std::string& keyword);

/// The rows of an array as radiance. They are checked on the way, while they are in the cache.
std::unique_ptr<RowSource> radiance_rows(ArrayPixels pixels, std::string keyword);

/// Numbers of an array as a NumPy array that owns them.
nb::object numpy_of(ImageF image, std::initializer_list<std::size_t> shape);
/// height x width x channels, or height x width where there is one channel.
nb::object numpy_of(ImageF image);
/// A picture of bytes, likewise.
nb::object numpy_of(Image<std::uint8_t> image);

}  // namespace domelight::python
