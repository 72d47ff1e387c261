#include "domelight/base/version.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/display_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "io/file/json.h"
#include "preview/screen_picture.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

struct SkyWords {
    CommonOptions common;
    std::string output, encoding = "auto";
    std::optional<int> height;
    SkyOptions sky;
    bool axes = false, no_sun_disc = false;
    DisplayWords display;
};

void declare(Arguments& a, SkyWords& w) {
    a.group("The picture");
    a.text("-o,--output", "FILE", w.output, "the output: .hdr, .exr, or .png or .jpg for viewing");
    a.integer("--height", "N", w.height, "rows of the lat-long image, 1 to 32768; it is twice as wide (512)");
    a.choice("--exr", w.encoding, {"auto", "half", "float"},
             "type of the channels of an .exr; half clips the sun at 65504, so auto is float if the sun is up (auto)");
    add_display_options(a, w.display, "with --axes");
    a.flag("--axes", w.axes,
           "the labelled six-axis environment instead of a sky: it reveals every mistake in orientation");
    a.group("The sky");
    a.number("--sun-elevation-deg", "DEGREES", w.sky.sun_elevation_deg,
             "height of the sun over the horizon, -18 to 90 (30)");
    a.number("--sun-azimuth-deg", "DEGREES", w.sky.sun_azimuth_deg,
             "azimuth of the sun, measured from +X towards +Z (30)");
    a.number("--turbidity", "T", w.sky.turbidity, "turbidity of the air, from 1 for pure air to 10 for haze (3)");
    a.number("--ground-albedo", "A", w.sky.ground_albedo, "albedo of the ground, 0 to 1 (0.2)");
    a.flag("--no-sun-disc", w.no_sun_disc, "the sky without the sun's disc");
    add_common_options(a, w.common);
}

Result<void> check(const SkyWords& w) {
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the picture goes: -o sky.hdr."};
    if (auto ok = check_ending("--output", w.output, light_and_screen_endings()); !ok) return ok;
    if (auto ok = check_display_options(w.display, w.output); !ok) return ok;
    if (auto ok = within("--height", w.height.value_or(512), 1, 32768); !ok) return ok;
    if (auto ok = within("--sun-elevation-deg", w.sky.sun_elevation_deg, -18, 90); !ok) return ok;
    if (auto ok = within("--sun-azimuth-deg", w.sky.sun_azimuth_deg, -3600, 3600); !ok) return ok;
    if (auto ok = within("--turbidity", w.sky.turbidity, 1, 10); !ok) return ok;
    return within("--ground-albedo", w.sky.ground_albedo, 0, 1);
}

/// Passes rows to a writer, reports the progress, and records the range.
class WatchedRows : public RowSource {
  public:
    WatchedRows(RowSource& rows, Progress progress) : rows_(rows), progress_(std::move(progress)) {}
    int width() const override { return rows_.width(); }
    int height() const override { return rows_.height(); }
    Result<void> read(ImageView<float> rows) override {
        auto ok = rows_.read(rows);
        for (int y = 0; ok && y < rows.height; ++y)
            largest_ = std::max(largest_, *std::max_element(rows.row(y), rows.row(y) + rows.width * rows.channels));
        done_ += rows.height;
        if (progress_) progress_("sky", double(done_) / height());
        return ok;
    }
    float largest() const { return largest_; }

  private:
    RowSource& rows_;
    Progress progress_;
    int done_ = 0;
    float largest_ = 0;
};

/// What is to be written, and the picture that its rows come from where it is not made row by row.
struct Source {
    ImageF axes;
    std::unique_ptr<RowSource> rows;
};

std::unique_ptr<Source> open_source(const SkyWords& w) {
    auto source = std::make_unique<Source>();
    if (w.axes) {
        source->axes = make_axes_environment(w.sky.height);
        source->rows = std::make_unique<ImageRowSource>(source->axes.view());
    } else {
        source->rows = make_sky(w.sky);
    }
    return source;
}

bool is_exr(const SkyWords& w) {
    return lower_case_extension(w.output) == ".exr";
}

/// Half or float channels of an .exr. To find out whether halves are enough, the rows down to the sun are made twice:
/// a file of floats would be twice as large where halves are.
Result<std::string> choose_channels(const SkyWords& w) {
    if (!is_exr(w) || w.encoding != "auto") return w.encoding;
    const auto fits = fits_half(*open_source(w)->rows);
    if (!fits) return fits.error();
    return std::string(*fits ? "half" : "float");
}

/// The axes have the colours of a screen and are shown as they are.
Result<void> write_for_screen(const SkyWords& w, WatchedRows& rows) {
    const auto image = read_latlong(rows);
    if (!image) return image.error();
    const Display display = display_of(w.display, w.axes, [&] { return automatic_ev(image->view()); });
    return write_screen_picture(w.output, screen_picture(*image, {}, display, w.sky.threads));
}

Result<void> write(const SkyWords& w, const std::string& channels, WatchedRows& rows) {
    if (is_screen_picture(w.output)) return write_for_screen(w, rows);
    if (lower_case_extension(w.output) == ".hdr") return write_hdr(w.output, rows);
    ExrWriteOptions exr;
    exr.half = channels == "half";
    return write_exr(w.output, rows, exr);
}

void print_result(const SkyWords& w, const std::string& channels, const WatchedRows& rows) {
    const int height = w.sky.height;
    if (w.common.json) {
        Json json{{"version", version()},
                  {"file", w.output},
                  {"width", 2 * height},
                  {"height", height},
                  {"largest", rows.largest()}};
        if (is_exr(w)) json["channels"] = channels;
        if (!w.axes)
            json["sky"] = {{"sun_elevation_deg", w.sky.sun_elevation_deg},
                           {"sun_azimuth_deg", w.sky.sun_azimuth_deg},
                           {"turbidity", w.sky.turbidity},
                           {"ground_albedo", w.sky.ground_albedo},
                           {"sun_disc", w.sky.sun_disc}};
        print_document(json);
    } else if (!w.common.quiet) {
        print("{}: {} x {}, values up to {:.6g}\n", w.output, 2 * height, height, rows.largest());
        if (is_exr(w) && w.encoding == "auto" && channels == "float")
            print("32-bit float channels: {}\n", k_why_float_channels);
    }
}

}  // namespace

int run_sky(const std::vector<std::string>& words) {
    SkyWords w;
    Arguments arguments(
        "sky",
        "Writes a physically based clear or hazy sky with a sun of true size and radiance, as a lat-long environment. "
        "A command that is given no environment uses the sky of the default options, eight stops darker.",
        {"domelight sky -o sky.hdr", "domelight sky -o evening.exr --sun-elevation-deg 4 --turbidity 5 --height 256",
         "domelight sky --axes -o axes.png"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (auto ok = check(w); !ok) return print_error(ok.error(), exit_usage);
    if (auto ok = check_output_places({w.output}); !ok) return print_error(ok.error());
    warn_of_idle_options(arguments,
                         {{"--exr", is_exr(w), "an .exr"},
                          {"--sun-elevation-deg", !w.axes, "a sky, not with --axes"},
                          {"--sun-azimuth-deg", !w.axes, "a sky, not with --axes"},
                          {"--turbidity", !w.axes, "a sky, not with --axes"},
                          {"--ground-albedo", !w.axes, "a sky, not with --axes"},
                          {"--no-sun-disc", !w.axes, "a sky, not with --axes"}},
                         w.common);
    w.sky.height = w.height.value_or(512);
    w.sky.sun_disc = !w.no_sun_disc;
    w.sky.threads = w.common.threads.value_or(0);

    const auto channels = choose_channels(w);
    if (!channels) return print_error(channels.error().at(w.output));
    const auto source = open_source(w);
    ProgressBar bar(w.output, w.common);
    WatchedRows rows(*source->rows, bar.callback());
    if (auto ok = write(w, *channels, rows); !ok) return print_error(ok.error().at(w.output));
    if (is_screen_picture(w.output) && !w.axes)
        print_warnings({w.output + " is for the eye: write .hdr or .exr for light"}, w.common);
    if (is_exr(w) && w.encoding == "half" && rows.largest() > 65504)
        print_warnings({fmt::format("{}: half floats clip the sun ({:.4g}) at 65504; --exr float keeps it", w.output,
                                    rows.largest())},
                       w.common);
    print_result(w, *channels, rows);
    return exit_done;
}

}  // namespace domelight::cli
