#include "domelight/bake/brdf_file.h"

#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "base/field_place.h"
#include "io/picture/png_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace domelight {
namespace {

/// The first channels of an image; those it lacks are 0.
ImageF with_channels(ImageView<const float> image, int channels) {
    ImageF out(image.width, image.height, channels);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            std::copy_n(image.at(x, y), std::min(channels, image.channels), out.at(x, y));
    return out;
}

/// A table of three channels with those of its form: 2, or 3 for scale_bias_charlie.
ImageF channels_of(ImageView<const float> table, BrdfForm form) {
    if (form == BrdfForm::scale_bias_charlie) return with_channels(table, 3);
    if (form == BrdfForm::multiscatter) return with_channels(brdf_table_multiscatter(table), 2);
    return with_channels(table, 2);
}

std::map<std::string, std::string> brdf_metadata(BrdfForm form) {
    return {{"domelight.version", version()},
            {"domelight.quantity", fmt::format("brdf {}", name_of(form))},
            {"domelight.convention", k_brdf_axes}};
}

Result<void> write_linear_png(const std::filesystem::path& file, const ImageF& rgb) {
    Image<std::uint8_t> pixels(rgb.width(), rgb.height(), rgb.channels());
    std::ranges::transform(rgb.pixels(), pixels.pixels().begin(),
                           [](float value) { return std::uint8_t(std::lround(255 * std::clamp(value, 0.f, 1.f))); });
    const auto bytes = encode_png(pixels.view());
    if (!bytes) return bytes.error();
    return write_file_atomically(file, *bytes);
}

}  // namespace

ImageF brdf_table(const BrdfFileOptions& options) {
    const BrdfTableOptions table{options.size, options.g, options.threads};
    if (options.points) return brdf_table_montecarlo(table, *options.points);
    const ImageF& embedded = brdf_table_default();
    return table.size == embedded.width() && table.g == BrdfG::correlated ? embedded : brdf_table(table);
}

Texture brdf_texture(ImageView<const float> table, const BrdfFileOptions& options) {
    const ImageF image = channels_of(table, options.form);
    const bool three = image.channels() == 3, single = options.single_precision;
    Texture texture = encode_table(
        image, three ? (single ? Encoding::rgba32f : Encoding::rgba16f) : (single ? Encoding::rg32f : Encoding::rg16f));
    texture.metadata = brdf_metadata(options.form);
    return texture;
}

std::span<const std::string> brdf_file_extensions() {
    static const std::vector<std::string> all{".ktx2", ".ktx", ".dds", ".exr", ".hdr", ".png"};
    return all;
}

Result<void> write_brdf_file(const std::filesystem::path& file, const BrdfFileOptions& options) {
    if (options.size < 1 || options.size > 4096)
        return Error{fmt::format("{} is not from 1 to 4096", options.size), field_place("size"), ""};
    if (options.form == BrdfForm::none) return Error{"none has no channels to write", field_place("form"), ""};
    const std::string extension = lower_case_extension(file);
    const ImageF table = brdf_table(options);
    if (extension == ".ktx2") return write_ktx2(file, brdf_texture(table, options));
    if (extension == ".ktx") return write_ktx1(file, brdf_texture(table, options));
    if (extension == ".dds") return write_dds(file, brdf_texture(table, options));
    const ImageF image = channels_of(table, options.form);
    if (extension == ".exr") {
        ExrWriteOptions exr;
        exr.half = !options.single_precision;
        exr.attributes = brdf_metadata(options.form);
        exr.threads = options.threads;
        return write_exr(file, image.view(), exr);
    }
    const ImageF rgb = with_channels(image, 3);
    if (extension == ".hdr") return write_hdr(file, rgb.view(), options.threads);
    if (extension == ".png") return write_linear_png(file, rgb);
    return Error{fmt::format("\"{}\" is not an ending of a BRDF table's file", extension), file.string(),
                 fmt::format("Accepted: {}.", fmt::join(brdf_file_extensions(), ", "))};
}

}  // namespace domelight
