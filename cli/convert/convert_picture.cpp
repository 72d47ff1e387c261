#include "cli/convert/convert_picture.h"

#include "domelight/base/version.h"
#include "domelight/compare/picture_reader.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "io/file/json.h"
#include "preview/screen_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace domelight::cli {
namespace {

void multiply(ImageF& image, float factor) {
    for (float& v : image.pixels()) v *= factor;
}

/// Colour and opacity side by side, as OpenEXR stores them.
ImageF with_opacity(const ImageF& rgb, const ImageF& opacity) {
    ImageF out(rgb.width(), rgb.height(), 4);
    for (std::size_t i = 0; i < opacity.pixels().size(); ++i) {
        std::copy_n(&rgb.pixels()[3 * i], 3, &out.pixels()[4 * i]);
        out.pixels()[4 * i + 3] = opacity.pixels()[i];
    }
    return out;
}

Result<void> write(const PictureConversion& c, const Picture& picture, const Display& display, int threads) {
    const bool cut_out = picture.cut_out();
    if (is_screen_picture(c.output)) {
        const bool transparent = cut_out && holds_opacity(c.output);
        return write_screen_picture(
            c.output, screen_picture(picture.rgb, transparent ? picture.opacity.view() : ImageView<const float>(),
                                     display, threads));
    }
    if (lower_case_extension(c.output) == ".hdr") return write_hdr(c.output, picture.rgb, threads);
    ExrWriteOptions exr;
    if (c.encoding == "half" || c.encoding == "float") exr.half = c.encoding == "half";
    exr.threads = threads;
    return picture.opacity.empty() ? write_exr(c.output, picture.rgb, exr)
                                   : write_exr(c.output, with_opacity(picture.rgb, picture.opacity), exr);
}

void print_result(const PictureConversion& c, const Picture& picture, const Display& display,
                  const CommonOptions& common) {
    const int width = picture.rgb.width(), height = picture.rgb.height();
    const bool screen = is_screen_picture(c.output);
    const std::string tonemap = name_of(display.method);
    const double ev = std::log2(display.exposure);
    if (common.json) {
        Json json{{"version", version()},
                  {"source", {{"file", c.input}, {"format", picture.format}, {"layer", picture.layer}}},
                  {"files", Json::array({c.output})},
                  {"projection", nullptr},
                  {"width", width},
                  {"height", height}};
        if (screen) json["tonemap"] = tonemap, json["ev"] = ev;
        print_document(json);
    } else if (!common.quiet) {
        print("{}: {} x {}, every pixel as it is{}\n", c.output, width, height,
              screen ? fmt::format(", tone map {}, exposure {:+.2f} stops", tonemap, ev) : "");
    }
}

}  // namespace

bool may_be_a_picture(const std::string& file) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure)) return false;  // a pipe cannot be read twice
    const auto facts = read_picture_facts(file);
    return facts && !facts->cube;
}

bool holds_a_picture(const std::string& file) {
    return may_be_a_picture(file) && is_picture_of_its_own(file);
}

Result<void> check_picture_output(const PictureConversion& c) {
    if (auto ok = check_ending("OUT", c.output, light_and_screen_endings()); !ok) return ok;
    const bool exr = lower_case_extension(c.output) == ".exr";
    const bool channels = c.encoding == "auto" || c.encoding == "half" || c.encoding == "float";
    if (!c.encoding.empty() && !(exr && channels))
        return Error{fmt::format("\"{}\" does not go with {}", c.encoding, lower_case_extension(c.output)),
                     "--encoding",
                     "A picture in an .exr: auto, half, float. The other formats have one encoding each."};
    return check_display_options(c.display, c.output);
}

int convert_picture(const PictureConversion& c, const CommonOptions& common) {
    const int threads = common.threads.value_or(0);
    PictureOptions options;
    options.layer = c.layer;
    options.opacity = true;
    options.decode = c.decode;
    options.threads = threads;
    auto picture = read_picture(c.input, options);
    if (!picture) return print_error(picture.error());
    multiply(picture->rgb, float(std::exp2(c.exposure)));
    const Display display = display_of(c.display, !picture->high_dynamic_range, [&] {
        return c.exposure != 0 ? 0 : automatic_ev(picture->rgb, picture->opacity, picture->cut_out());
    });
    if (auto ok = write(c, *picture, display, threads); !ok) return print_error(ok.error().at(c.output));
    print_warnings(picture->warnings, common, c.input);
    if (c.encoding == "half" && !fits_half(picture->rgb.view()))
        print_warnings({"half floats clip what is beyond 65504: leave out --encoding half"}, common, c.output);
    if (picture->cut_out() && !holds_opacity(c.output) && is_screen_picture(c.output))
        print_warnings({c.output + ": JPEG holds no opacity: the picture stands on black"}, common);
    print_result(c, *picture, display, common);
    return exit_done;
}

}  // namespace domelight::cli
