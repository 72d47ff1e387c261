#include "c/pixels.h"

#include "domelight/base/parallel.h"

#include "sampling/radiance_check.h"
#include "texture/texel/half.h"

#include <cstdint>

namespace domelight::c {
namespace {

constexpr int k_most_side = 65536;

Error field_error(const char* field, int value, const char* expected) {
    return {text(value, " is not ", expected), field_place(field), ""};
}

Result<void> check_shape(const domelight_pixels& p, int channels) {
    if (auto ok = check_given({{p.data, "data"}}); !ok) return ok;
    if (p.faces != 1 && p.faces != 6) return field_error("faces", p.faces, "1 or 6");
    if (p.bits != 16 && p.bits != 32) return field_error("bits", p.bits, "16 or 32");
    if (p.width < 1 || p.width > k_most_side) return field_error("width", p.width, "from 1 to 65536");
    if (p.height < 1 || p.height > k_most_side) return field_error("height", p.height, "from 1 to 65536");
    if (p.faces == 6 && p.width != p.height)
        return Error{text("a face is ", p.width, " x ", p.height, ", but the faces of a cube are square"),
                     field_place("height"), ""};
    if (p.channels != channels && !(channels == 3 && p.channels == 4))
        return Error{text(p.channels, " is not ", channels, channels == 3 ? " or 4" : ""), field_place("channels"), ""};
    if (p.row_stride != 0 && std::int64_t(p.row_stride) < std::int64_t(p.width) * p.channels)
        return Error{text(p.row_stride, " is less than the ", std::int64_t(p.width) * p.channels, " channels of a row"),
                     field_place("row_stride"), "0 stands for rows without gaps."};
    return {};
}

float number(float value) {
    return value;
}
float number(std::uint16_t half) {
    return float_from_half(half);
}

/// Rows begin .. end of the image from the caller's.
template <typename Stored>
void copy_rows(const domelight_pixels& p, ImageF& image, int begin, int end) {
    const std::ptrdiff_t stride = p.row_stride ? p.row_stride : std::ptrdiff_t(p.width) * p.channels;
    const int channels = image.channels();
    for (int y = begin; y < end; ++y) {
        const Stored* in = static_cast<const Stored*>(p.data) + stride * y;
        float* out = image.row(y);
        for (int x = 0; x < p.width; ++x, in += p.channels, out += channels)
            for (int channel = 0; channel < channels; ++channel) out[channel] = number(in[channel]);
    }
}

}  // namespace

domelight_pixels pixels_of(const ImageF& image, int faces) {
    domelight_pixels pixels{};
    pixels.struct_size = sizeof pixels;
    pixels.data = image.pixels().data();
    pixels.width = image.width();
    pixels.height = image.height() / faces;
    pixels.faces = faces;
    pixels.channels = image.channels();
    pixels.bits = 32;
    return pixels;
}

Result<ImageF> copy_pixels(const domelight_pixels& pixels, int channels) {
    if (auto ok = check_shape(pixels, channels); !ok) return ok.error();
    auto image = ImageF::uninitialized(pixels.width, pixels.height * pixels.faces, channels);
    parallel_ranges(image.height(), 64, 0, [&](int begin, int end) {
        pixels.bits == 16 ? copy_rows<std::uint16_t>(pixels, image, begin, end)
                          : copy_rows<float>(pixels, image, begin, end);
    });
    return image;
}

Result<void> check_faces(const ImageF& image, int faces) {
    const int height = image.height() / faces;
    for (int f = 0; f < faces; ++f)
        if (auto ok = check_radiance(image.view().rows(f * height, height), 0); !ok)
            return ok.error().at(faces == 1 ? "" : text("face ", f));
    return {};
}

}  // namespace domelight::c

using namespace domelight;

extern "C" {

void domelight_pixels_init_sized(domelight_pixels* pixels, size_t struct_size) {
    domelight_pixels defaults{};
    defaults.faces = 1;
    defaults.channels = 3;
    defaults.bits = 32;
    c::init_struct(pixels, struct_size, defaults);
}

domelight_error* domelight_image_pixels(const domelight_image* image, domelight_pixels* pixels) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{image, "image"}, {pixels, "pixels"}}); !ok) return ok;
        return c::write_struct(pixels, c::pixels_of(*image->image, image->faces));
    });
}

void domelight_image_free(domelight_image* image) {
    delete image;
}

}  // extern "C"
