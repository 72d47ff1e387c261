#include "array_input.h"

#include "base/field_place.h"
#include "texture/texel/half.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace domelight::python {
namespace {

Error array_error(const char* keyword, std::string what, std::string hint = "") {
    return {std::move(what), field_place(keyword), std::move(hint)};
}

std::string type_name(const nb::dlpack::dtype& type) {
    using Code = nb::dlpack::dtype_code;
    switch (Code(type.code)) {
        case Code::Int:
            return fmt::format("int{}", type.bits);
        case Code::UInt:
            return fmt::format("uint{}", type.bits);
        case Code::Float:
            return fmt::format("float{}", type.bits);
        case Code::Bfloat:
            return "bfloat16";
        case Code::Complex:
            return fmt::format("complex{}", type.bits);
        case Code::Bool:
            return "bool";
        default:
            return "another type";
    }
}

std::string shape_text(const AnyArray& array) {
    std::string text = "(";
    for (std::size_t i = 0; i < array.ndim(); ++i) text += fmt::format("{}{}", i ? ", " : "", array.shape(i));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

/// Imports the object as an array, without a copy.
AnyArray import_array(nb::handle object, const char* keyword) {
    const nb::object requires_grad = nb::getattr(object, "requires_grad", nb::none());
    if (requires_grad.ptr() == Py_True)
        throw Failure(array_error(keyword, "a tensor that requires a gradient, which would be lost",
                                  "Pass tensor.detach(), or use domelight.torch."));
    AnyArray array;
    if (!nb::try_cast(object, array, false)) {
        throw Failure(array_error(keyword,
                                  fmt::format("no array of numbers can be read from this {}",
                                              nb::cast<std::string>(object.type().attr("__name__"))),
                                  "Expected is an array of float32 of shape (height, width, 3), as of NumPy or PyTorch."));
    }
    if (array.device_type() != nb::device::cpu::value)
        throw Failure(array_error(keyword, "the array is not in the CPU's memory", "Pass a copy on the CPU: array.cpu()."));
    return array;
}

ArrayPixels::Type number_type(const AnyArray& array, const char* keyword, bool bytes_too) {
    const nb::dlpack::dtype type = array.dtype();
    if (bytes_too && type == nb::dtype<std::uint8_t>()) return ArrayPixels::Type::byte;
    if (nb::dlpack::dtype_code(type.code) == nb::dlpack::dtype_code::Float && type.lanes == 1) {
        if (type.bits == 16) return ArrayPixels::Type::half;
        if (type.bits == 32) return ArrayPixels::Type::single;
        if (type.bits == 64) return ArrayPixels::Type::wide;
    }
    throw Failure(array_error(keyword, "dtype is " + type_name(type) + ", expected float32",
                              type.code == std::uint8_t(nb::dlpack::dtype_code::UInt)
                                  ? "Eight bits of a picture are no radiance: decode their sRGB curve to float32 first."
                                  : "Pass array.astype(numpy.float32)."));
}

void check_shape(const AnyArray& array, int channels, const char* keyword) {
    const std::size_t axes = array.ndim();
    const std::string wanted = channels == 1 ? "(height, width)" : fmt::format("(height, width, {})", channels);
    const bool bare = channels == 1 && (axes == 2 || (axes == 3 && array.shape(2) != 1));
    const bool fits = bare ? axes == 2 : (axes == 3 || axes == 4) && int(array.shape(axes - 1)) == channels;
    if (!fits) {
        const bool channels_first = axes == 3 && int(array.shape(0)) == channels;
        throw Failure(array_error(keyword, fmt::format("shape is {}, expected {}", shape_text(array), wanted),
                                  channels_first ? "The channels come last: numpy.moveaxis(array, 0, -1)."
                                  : axes >= 3 && array.shape(axes - 1) == 4 && channels == 3
                                      ? "Leave the opacity out: array[..., :3]."
                                      : ""));
    }
    for (std::size_t i = 0; i < axes; ++i)
        if (array.shape(i) == 0 || array.shape(i) > 65536)
            throw Failure(array_error(
                keyword, fmt::format("shape is {}, expected sides from 1 to 65536", shape_text(array))));
    if (!array.data()) throw Failure(array_error(keyword, "the array's memory has been freed"));
}

/// A shared array whose last copy takes the interpreter's lock to let go of it.
std::shared_ptr<const AnyArray> shared(AnyArray array) {
    return {new AnyArray(std::move(array)), [](const AnyArray* owned) {
                const nb::gil_scoped_acquire lock;
                delete owned;
            }};
}

template <typename T>
float number_at(const char* place) {
    T value;
    std::memcpy(&value, place, sizeof value);
    return float(value);
}
struct Half {
    std::uint16_t bits;
    explicit operator float() const { return float_from_half(bits); }
};

template <typename T>
void copy_strided(const char* from, float* to, int width, int channels, std::int64_t column, std::int64_t channel) {
    for (int x = 0; x < width; ++x)
        for (int c = 0; c < channels; ++c) *to++ = number_at<T>(from + x * column + c * channel);
}

bool is_light(float value) {
    return value >= 0 && value <= std::numeric_limits<float>::max();
}

/// Whether all values are finite and not negative. By their bits, which is several times as fast as comparing: the sign
/// bit is set of negative values, and 0x00800000 carries the exponent of infinities and NaNs into it.
bool all_are_light(const float* values, int count) {
    std::uint32_t signs = 0;
    for (int i = 0; i < count; ++i) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(values[i]);
        signs |= bits | (bits + 0x00800000u);
    }
    return signs >> 31 == 0 || std::all_of(values, values + count, is_light);  // -0 is light
}

/// Copies values, and returns whether all_are_light(): in one pass, while they are in registers.
bool copy_light(const float* from, float* to, int count) {
    std::uint32_t signs = 0;
    for (int i = 0; i < count; ++i) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(from[i]);
        signs |= bits | (bits + 0x00800000u);
        to[i] = std::bit_cast<float>(bits);
    }
    return signs >> 31 == 0 || std::all_of(to, to + count, is_light);
}

class ArrayRows : public RowSource {
  public:
    ArrayRows(ArrayPixels pixels, std::string keyword) : pixels_(std::move(pixels)), keyword_(std::move(keyword)) {}
    int width() const override { return pixels_.width(); }
    int height() const override { return pixels_.height(); }
    Result<void> read(ImageView<float> rows) override {
        const int first = next_row_;
        next_row_ += rows.height;
        if (!pixels_.viewable()) {
            pixels_.copy_rows(first, rows);
            return check_radiance(rows, first, keyword_);
        }
        const ImageView<const float> from = pixels_.view().rows(first, rows.height);
        bool light = true;
        for (int y = 0; y < rows.height; ++y) light &= copy_light(from.row(y), rows.row(y), rows.width * rows.channels);
        return light ? Result<void>() : check_radiance(rows, first, keyword_);
    }

  private:
    ArrayPixels pixels_;
    std::string keyword_;
    int next_row_ = 0;
};

template <typename T>
nb::object numpy_owning(Image<T> image, std::size_t axes, const std::size_t* shape) {
    auto owned = std::make_unique<Image<T>>(std::move(image));
    T* const data = owned->pixels().data();
    nb::capsule owner(owned.get(), [](void* p) noexcept { delete static_cast<Image<T>*>(p); });
    (void)owned.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(data, axes, shape, owner));
}

template <typename T>
nb::object numpy_picture(Image<T> image) {
    const std::size_t shape[3] = {std::size_t(image.height()), std::size_t(image.width()), std::size_t(image.channels())};
    return numpy_owning(std::move(image), shape[2] == 1 ? 2 : 3, shape);
}

}  // namespace

ArrayPixels ArrayPixels::borrow(nb::handle object, int channels, const char* keyword, bool bytes_too) {
    AnyArray array = import_array(object, keyword);
    ArrayPixels pixels;
    pixels.type_ = number_type(array, keyword, bytes_too);
    check_shape(array, channels, keyword);
    const std::int64_t bytes = array.itemsize();
    const bool bare = channels == 1 && array.ndim() == 2;
    pixels.has_charts_ = array.ndim() == 4;
    const std::size_t rows = pixels.has_charts_ ? 1 : 0;
    if (pixels.has_charts_) {
        pixels.charts_ = int(array.shape(0));
        pixels.chart_stride_ = array.stride(0) * bytes;
    }
    pixels.chart_height_ = int(array.shape(rows));
    pixels.width_ = int(array.shape(rows + 1));
    pixels.channels_ = channels;
    pixels.row_stride_ = array.stride(rows) * bytes;
    pixels.column_stride_ = array.stride(rows + 1) * bytes;
    pixels.channel_stride_ = bare ? bytes : array.stride(rows + 2) * bytes;
    pixels.data_ = static_cast<const char*>(array.data());
    pixels.owner_ = shared(std::move(array));
    return pixels;
}

bool ArrayPixels::viewable() const {
    const std::int64_t number = sizeof(float);
    return type_ == Type::single && (channels_ == 1 || channel_stride_ == number) &&
           (width_ == 1 || column_stride_ == channels_ * number) && row_stride_ % number == 0 && row_stride_ > 0 &&
           (charts_ == 1 || chart_stride_ == chart_height_ * row_stride_) &&
           reinterpret_cast<std::uintptr_t>(data_) % alignof(float) == 0;
}

ImageView<const float> ArrayPixels::view() const {
    return {reinterpret_cast<const float*>(data_), width_, height(), channels_, row_stride_ / std::int64_t(sizeof(float))};
}

void ArrayPixels::copy_rows(int first, ImageView<float> out) const {
    const bool close = type_ == Type::single && (channels_ == 1 || channel_stride_ == sizeof(float)) &&
                       column_stride_ == std::int64_t(sizeof(float)) * channels_;
    for (int y = 0; y < out.height; ++y) {
        const char* const from = row(first + y);
        if (close)
            std::memcpy(out.row(y), from, sizeof(float) * std::size_t(width_) * std::size_t(channels_));
        else if (type_ == Type::single)
            copy_strided<float>(from, out.row(y), width_, channels_, column_stride_, channel_stride_);
        else if (type_ == Type::wide)
            copy_strided<double>(from, out.row(y), width_, channels_, column_stride_, channel_stride_);
        else if (type_ == Type::byte)
            copy_strided<std::uint8_t>(from, out.row(y), width_, channels_, column_stride_, channel_stride_);
        else
            copy_strided<Half>(from, out.row(y), width_, channels_, column_stride_, channel_stride_);
    }
}

ImageF ArrayPixels::copy() const {
    auto image = ImageF::uninitialized(width_, height(), channels_);
    copy_rows(0, image);
    return image;
}

Result<void> check_radiance(ImageView<const float> rows, int first_row, const std::string& keyword) {
    for (int y = 0; y < rows.height; ++y) {
        const float* const row = rows.row(y);
        const int count = rows.width * rows.channels;
        if (all_are_light(row, count)) continue;
        const auto bad = std::find_if(row, row + count, [](float v) { return !is_light(v); }) - row;
        return Error{fmt::format("{} at row {}, column {}, channel {} is no radiance, which is finite and not negative",
                                 row[bad], first_row + y, bad / rows.channels, bad % rows.channels),
                     field_place(keyword), "numpy.clip(numpy.nan_to_num(array), 0, None) is."};
    }
    return {};
}

std::unique_ptr<RowSource> radiance_rows(ArrayPixels pixels, std::string keyword) {
    return std::make_unique<ArrayRows>(std::move(pixels), std::move(keyword));
}

nb::object numpy_of(ImageF image, std::initializer_list<std::size_t> shape) {
    return numpy_owning(std::move(image), shape.size(), shape.begin());
}
nb::object numpy_of(ImageF image) {
    return numpy_picture(std::move(image));
}
nb::object numpy_of(Image<std::uint8_t> image) {
    return numpy_picture(std::move(image));
}

}  // namespace domelight::python
