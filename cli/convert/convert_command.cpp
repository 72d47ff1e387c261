#include "domelight/base/version.h"
#include "domelight/image/colour.h"
#include "domelight/image/cube_layout.h"
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projections.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/display_options.h"
#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "cli/console/suggestion.h"
#include "cli/convert/convert_picture.h"
#include "convert/converted_files.h"
#include "io/file/json.h"
#include "preview/screen_picture.h"
#include "projection/latlong_convention.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace domelight::cli {
namespace {

struct ConvertWords {
    CommonOptions common;
    std::vector<std::string> files;
    std::string to, mirror;
    std::vector<std::string> rotations;
    std::optional<int> size;
    bool sharp = false, picture = false;
    ConvertOutput output;
    DisplayWords display;
    EnvironmentOptions environment;
};

/// "latlong/usd, latlong/mitsuba, ...": all but the default.
std::string latlong_list() {
    std::vector<std::string> names = latlong_convention_names();
    names.erase(names.begin());
    for (std::string& name : names) name = "latlong/" + name;
    return join(names, ", ");
}

void declare(Arguments& a, ConvertWords& w) {
    a.positional("IN", w.files,
                 "an environment (or the six faces of a cube, a folder of them, front and back of a dual paraboloid), "
                 "or any picture, to write it as a .png, .jpg, .exr or .hdr. Without -o, the last name is the output, "
                 "which must not exist yet");
    a.text("-o,--output", "OUT", w.output.file,
           "the output: .hdr, .exr, .ktx2, .ktx, .dds, or .png or .jpg for viewing");
    a.group("What to make");
    a.text("--to", "PROJECTION", w.to,
           projection_list() + "; with its convention: " + latlong_list() +
               ", cube/openexr, or NAME/centre=+X,right=+Z,up=+Y (cube in a texture, else latlong)");
    a.integer("--size", "N", w.size,
              "height in pixels, 1 to 32768: of the picture, of a cube's face, or of one half of a dual paraboloid (as "
              "fine as the source)");
    a.flag("--sharp", w.sharp,
           "from lat-long to cube or lat-long: keep more of the finest detail; takes ten times as long");
    a.text("--layout", "NAME", w.output.layout,
           "a cube: " + join(cube_layout_names(), ", ") +
               ", or faces: name_px.hdr ... (cross); a dual paraboloid: side-by-side, or files: name_front.hdr and "
               "name_back.hdr (side-by-side)");
    a.text("--encoding", "NAME", w.output.encoding,
           ".exr: auto, half, float (auto: half, or float where half would clip); textures: rgba16f, rgba32f, rgb9e5, "
           "r11g11b10f, bc6h; in .ktx and .ktx2 also astc4x4-hdr, astc6x6-hdr; in .ktx2 also uastc-hdr, rgbm, rgbd, "
           "rgbp (rgba16f)");
    a.texts("--rotate", "X,Y,Z,DEGREES", w.rotations,
            "turn the light about an axis, clockwise as seen from the axis's tip: 0,1,0,90 is --rotate-y-deg 90; "
            "several are applied one after the other, after --up and --rotate-y-deg and before --mirror");
    a.text("--mirror", "AXIS", w.mirror, "mirror the light along the x, y or z axis");
    a.group("Pictures for a screen");
    add_display_options(a, w.display, "for a source of 8 bits", ", or where --exposure is given");
    a.flag("--picture", w.picture,
           "treat IN as a picture, not as an environment: every pixel stays where it is. Without this option that is "
           "done if OUT is a .png or .jpg and IN is not a cube texture, and if OUT is an .exr or .hdr and the shape or "
           "the layers of IN are not an environment's; but not if an option such as --to needs an environment");
    add_environment_options(a, w.environment);
    a.text("--from", "NAME", w.environment.projection, "the same as --projection");
    add_common_options(a, w.common);
}

Result<std::array<double, 4>> parse_rotation(const std::string& words) {
    const Error wrong{fmt::format("\"{}\" is not four numbers", words), "--rotate",
                      "Write an axis and degrees: X,Y,Z,DEGREES, as in 0,0,1,90."};
    const auto parts = split(words, ',');
    if (parts.size() != 4) return wrong;
    std::array<double, 4> v;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto number = parse_number(parts[k]);
        if (!number || !std::isfinite(*number)) return wrong;
        v[k] = *number;
    }
    return v;
}

Result<Mat3> light_turn(const ConvertWords& w) {
    std::vector<std::array<double, 4>> rotations;
    for (const std::string& words : w.rotations) {
        const auto rotation = parse_rotation(words);
        if (!rotation) return rotation.error();
        rotations.push_back(*rotation);
    }
    const auto turn = domelight::light_turn(rotations, w.mirror);
    if (turn) return turn;
    Error error = with_options(turn.error());
    if (error.where == "--rotate") error.hint = "Write an axis and degrees: X,Y,Z,DEGREES, as in 0,0,1,90.";
    return error;
}

double relative(double before, double after) {
    return before > 0 ? after / before - 1 : 0;
}

Json json_of(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

void print_json(const ConvertWords& w, const Environment& environment, const Conversion& made,
                const WrittenPicture& written) {
    Json json{{"version", version()},
              {"source",
               {{"file", environment.file.string()},
                {"layer", environment.layer},
                {"projection", environment.projection},
                {"width", environment.width},
                {"height", environment.height},
                {"repaired", environment.report().repaired()}}},
              {"files", written.files},
              {"projection", w.to},
              {"layout", w.output.layout},
              {"width", made.image.width()},
              {"height", made.image.height()},
              {"encoding", written.encoding_name},
              {"method", made.method},
              {"power",
               {{"before", json_of(made.power_before)},
                {"after", json_of(made.power_after)},
                {"relative_change", relative(luminance(made.power_before), luminance(made.power_after))}}},
              {"clipped_texels", written.encoding.clipped_texels},
              {"clipped_energy", written.encoding.clipped_energy}};
    print_document(json);
}

/// What the name of a method means.
std::string method_words(const std::string& method) {
    if (method == "copy") return "copy (texels only change places)";
    if (method == "exact") return "exact (the bilinear source, averaged over each texel)";
    return method + " (each texel's light goes to the texels that it overlaps)";
}

void print_text(const ConvertWords& w, const Conversion& made, const WrittenPicture& written) {
    const bool plain = w.output.layout == "picture" || w.output.layout == w.to;
    print("{}: {}{}, {} x {}{}\n", join(written.files, ", "), w.to, plain ? "" : fmt::format(" ({})", w.output.layout),
          made.image.width(), made.image.height(), made.image.projection.charts() > 1 ? " each" : "");
    const double before = luminance(made.power_before), after = luminance(made.power_after);
    print("radiant power {:.6g} before, {:.6g} after ({:+.2g} %); method: {}\n", before, after,
          100 * relative(before, after), method_words(made.method));
    if (written.widened) print("32-bit float channels: {}\n", k_why_float_channels);
}

Result<void> check(ConvertWords& w) {
    if (w.output.file.empty() && w.files.size() < 2)
        return Error{"is missing", "--output",
                     fmt::format("Say where the result goes: domelight convert {} -o OUT.",
                                 w.files.empty() ? "IN" : w.files[0])};
    if (w.output.file.empty()) {
        w.output.file = w.files.back();
        w.files.pop_back();
        if (std::error_code ignored; std::filesystem::exists(w.output.file, ignored))
            return Error{"exists already", w.output.file, "To replace it, write it after -o."};
    }
    if (auto ok = check_display_options(w.display, w.output.file); !ok) return ok;
    if (w.size && (*w.size < 1 || *w.size > 32768))
        return Error{fmt::format("{} is not from 1 to 32768", *w.size), "--size", ""};
    if (w.to.empty()) {
        w.to = has_texture_ending(w.output.file) ? "cube" : "latlong";
    }
    return {};
}

/// The projection that an unknown name was probably meant for, as a sentence, or nothing.
std::string meant_projection(const std::string& to) {
    std::vector<std::string> names;
    for (const ProjectionInfo& info : projections()) names.emplace_back(info.name);
    const std::string name = split(to, '/')[0];
    return std::ranges::count(names, name) ? "" : did_you_mean(name, names);
}

/// The first of the given options that needs an environment, and so does not go with a picture; empty: none was given.
std::string environment_option(const Arguments& a) {
    for (const char* option : {"--to", "--size", "--sharp", "--layout", "--rotate", "--mirror", "--projection",
                               "--latlong", "--faces", "--face-orientation", "--rotate-y-deg", "--up", "--from"})
        if (a.given(option)) return option;
    return "";
}

/// Whether the input is converted as a picture.
Result<bool> wants_picture(const ConvertWords& w, const Arguments& a) {
    const std::string other = environment_option(a);
    if (w.picture) {
        if (w.files.size() != 1)
            return Error{fmt::format("goes with one picture, not with {} files", w.files.size()), "--picture", ""};
        if (!other.empty())
            return Error{"keeps every pixel where it is, and does not go with " + other, "--picture", ""};
        return true;
    }
    if (w.files.size() != 1 || !other.empty() || has_texture_ending(w.output.file)) return false;
    if (!w.environment.layer.empty()) return true;
    const std::string extension = lower_case_extension(w.output.file);
    if (is_screen_picture(w.output.file)) return may_be_a_picture(w.files[0]);
    return (extension == ".exr" || extension == ".hdr") && holds_a_picture(w.files[0]);
}

int run_picture(const ConvertWords& w) {
    PictureConversion conversion;
    conversion.input = w.files[0];
    conversion.output = w.output.file;
    conversion.layer = w.environment.layer;
    conversion.decode = w.environment.decode;
    conversion.encoding = w.output.encoding == "srgb" && is_screen_picture(w.output.file) ? "" : w.output.encoding;
    conversion.exposure = w.environment.exposure;
    conversion.display = w.display;
    if (auto ok = check_picture_output(conversion); !ok) return print_error(ok.error(), exit_usage);
    return convert_picture(conversion, w.common);
}

/// How the target's pixels are shown on a screen. Each counts by its solid angle for the exposure.
Display display_for(const ConvertWords& w, const Environment& environment, const ProjectedImage& image) {
    const bool for_screen = environment.format == "PNG" || environment.format == "JPEG";
    return display_of(w.display, for_screen,
                      [&] { return w.environment.exposure != 0 ? 0.0 : automatic_ev_of_sphere(image); });
}

}  // namespace

int run_convert(const std::vector<std::string>& words) {
    ConvertWords w;
    Arguments arguments(
        "convert",
        "Converts an environment to another projection, convention, orientation, size or format. Light is kept: "
        "texels are averaged by solid angle, and the radiant power before and after is printed. Without IN, the source "
        "is " +
            std::string(k_built_in_sky) +
            ". Any other picture (a render, a layer of one) becomes a .png or .jpg with a tone map, or an .exr or .hdr "
            "without one.",
        {"domelight convert studio.hdr -o studio_cube.hdr --to cube --layout faces --size 32",
         "domelight convert studio.hdr -o studio_usd.exr --to latlong/usd --exposure 1",
         "domelight convert studio.hdr -o ball.hdr --to mirror-ball/fov=20 --size 64",
         "domelight convert ball.hdr -o studio_again.hdr --from mirror-ball/fov=20",
         "domelight convert studio.hdr -o studio.ktx2 --rotate 0,0,1,90 --mirror x --encoding rgb9e5",
         "domelight convert studio.hdr -o studio.jpg --tonemap neutral --ev -1"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (auto ok = check(w); !ok) return print_error(ok.error(), exit_usage);
    if (auto ok = check_output_places({w.output.file}); !ok) return print_error(ok.error());
    const auto picture = wants_picture(w, arguments);
    if (!picture) return print_error(picture.error(), exit_usage);
    if (*picture) return run_picture(w);
    const auto target = projection_from_name(w.to);
    if (!target)
        return print_error({target.error().what, "--to", meant_projection(w.to) + target.error().hint}, exit_usage);
    if (auto ok = check_converted_files(w.output, *target); !ok)
        return print_error(with_options(ok.error()), exit_usage);
    warn_of_idle_options(
        arguments,
        {{"--sharp", target->name() == "cube" || target->name().starts_with("latlong"), "--to cube or latlong"}},
        w.common);
    const auto turn = light_turn(w);
    if (!turn) return print_error(turn.error(), exit_usage);

    const int threads = w.common.threads.value_or(0);
    w.environment.threads = w.output.threads = threads;
    auto environment = open_environment_or_sky(w.files, w.environment);
    if (!environment) return print_error(environment.error());
    w.output.inputs = environment->files;
    const auto size = chart_size(*target, w.size.value_or(matched_height(*environment, *target)));
    if (!size) return print_error(with_options(size.error()));
    ProgressBar bar(w.output.file, w.common);
    ConvertOptions options{*turn, size->first, size->second, w.sharp, threads, bar.callback()};
    const auto made = convert(*environment, *target, options);
    if (!made) return print_error(made.error());
    if (is_screen_picture(w.output.file)) w.output.display = display_for(w, *environment, made->image);
    const auto written = write_projected(made->image, w.output);
    if (!written) return print_error(written.error());
    print_warnings(environment->report().lines(), w.common);
    if (is_screen_picture(w.output.file))
        print_warnings({w.output.file + " is for the eye: write .hdr or .exr for light"}, w.common);
    if (const EncodingReport& e = written->encoding; e.clipped_texels > 0)
        print_warnings({fmt::format("{} clips {} texels and {:.3g} % of the power", written->encoding_name,
                                    e.clipped_texels, 100 * e.clipped_energy)},
                       w.common, w.output.file);
    if (!target->full())
        print_warnings({fmt::format("{} shows {:.0f} % of all directions: the rest is lost", target->name(),
                                    25 * target->shape().coverage() / k_pi)},
                       w.common);
    if (w.common.json)
        print_json(w, *environment, *made, *written);
    else if (!w.common.quiet)
        print_text(w, *made, *written);
    return exit_done;
}

}  // namespace domelight::cli
