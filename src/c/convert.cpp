// Any projection to any other, and pictures of light as files.
#include "domelight/io/environment/convert.h"

#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "c/environment.h"
#include "c/pixels.h"

#include <cmath>
#include <string>

using namespace domelight;

namespace {

constexpr domelight_convert_options k_options{};
/// Bytes of the largest picture that is made.
constexpr std::int64_t k_most_bytes = std::int64_t(4) << 30;
constexpr int k_most_height = 32768;

struct ConvertRequest {
    Projection target;
    ConvertOptions options;
};

Result<ConvertRequest> read_options(const domelight_convert_options* options, const Environment& environment) {
    const auto given = c::read_struct(options, k_options);
    if (!given) return given.error();
    const auto target = projection_from_name(c::text_or(given->to, "latlong"));
    if (!target) return target.error().at(field_place("to"));
    if (given->height < 0 || given->height > k_most_height)
        return Error{text(given->height, " is not from 0 to ", k_most_height), field_place("height"), ""};
    if (auto ok = c::check_threads(given->threads); !ok) return ok.error();
    ConvertOptions read;
    read.height = given->height ? given->height : matched_height(environment, *target);
    const std::int64_t width = std::llround(read.height * target->shape().aspect());
    const std::int64_t bytes = width * read.height * target->charts() * 3 * std::int64_t(sizeof(float));
    if (bytes > k_most_bytes)
        return Error{text(width, " x ", read.height, " texels a picture need ", bytes,
                          " bytes, more than the limit of ", k_most_bytes),
                     field_place("height"), ""};
    read.width = int(width);
    read.sharp = given->sharp != 0;
    read.threads = given->threads;
    read.progress = c::progress_of(given->progress, given->progress_data);
    return ConvertRequest{*target, read};
}

}  // namespace

extern "C" {

void domelight_convert_options_init_sized(domelight_convert_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, k_options);
}

domelight_error* domelight_convert(const domelight_environment* environment, const domelight_convert_options* options,
                                   domelight_image** image) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {image, "image"}}); !ok) return ok;
        const auto request = read_options(options, environment->environment);
        if (!request) return request.error();
        auto made = convert(environment->environment, request->target, request->options);
        if (!made) return made.error();
        return c::hand_out(image, std::make_shared<const ImageF>(std::move(made->image.pixels)),
                           request->target.charts());
    });
}

domelight_error* domelight_pixels_write(const domelight_pixels* pixels, const char* file) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{pixels, "pixels"}, {file, "file"}}); !ok) return ok;
        const auto given = c::read_struct(pixels, {});
        if (!given) return given.error();
        const auto image = c::copy_pixels(*given, 3);
        if (!image) return image.error();
        const std::string ending = lower_case_extension(file);
        if (ending == ".exr") return write_exr(file, *image);
        if (ending == ".hdr") return write_hdr(file, *image);
        return Error{"does not end in .exr or .hdr", file, ""};
    });
}

}  // extern "C"
