#include "domelight/base/version.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"
#include "domelight/sampling/light_extraction.h"

#include "bake/staging.h"
#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "io/file/json.h"
#include "io/file/output_place.h"
#include "io/file/sha256.h"
#include "preview/lights_sheet.h"
#include "scene/gltf/gltf_lights_writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

struct LightsWords {
    CommonOptions common;
    std::vector<std::string> environment_files;
    std::string output, format = "auto";
    std::optional<int> max_lights;
    double lux_per_unit = 1;
    bool no_preview = false;
    LightExtractionOptions options;
    EnvironmentOptions environment;
};

void declare(Arguments& a, LightsWords& w) {
    a.positional(
        "ENV", w.environment_files,
        fmt::format("an environment; without one, {}; six faces (px nx py ny pz nz) are one cube", k_built_in_sky));
    a.group("What counts as a light");
    a.integer("--max-lights", "N", w.max_lights,
              "the largest number of lights, 0 to 1024; weaker ones stay in the remainder (8)");
    a.number("--least-share", "SHARE", w.options.least_share,
             "the least share of all luminance that a light must "
             "have, 0 to 1 (0.01)");
    a.number("--least-contrast", "RATIO", w.options.least_contrast,
             "the peak luminance of a light must be at least this many times the luminance around it, 1.5 to 1e6 (4)");
    a.number("--largest-diameter-deg", "DEGREES", w.options.largest_diameter_deg,
             "the largest diameter of a source that may become a light, 0.001 to 30; a source of at most three texels "
             "across may be larger. If one texel is wider than this, no light is found (6)");
    a.number("--merge-deg", "DEGREES", w.options.merge_deg,
             "sources closer than this, 0 to 30, are merged into one light (1.5)");
    a.group("What to write");
    a.text("-o,--output", "DIR", w.output,
           "folder for lights.json, lights.gltf, remainder.hdr or .exr, and preview.png");
    a.choice("--format", w.format, {"auto", "hdr", "exr"},
             "format of the remainder; exr has 32-bit floats (auto: hdr where ENV is Radiance HDR, else exr)");
    a.number("--lux-per-unit", "LUX", w.lux_per_unit,
             "the illuminance in lux that lights.gltf states for an irradiance of 1: 1 keeps the environment's unit; "
             "683 or 179 lm/W where radiance is in W/(m^2 sr) (1)");
    a.flag("--no-preview", w.no_preview, "no preview.png");
    add_environment_options(a, w.environment);
    add_common_options(a, w.common);
}

Result<void> check(const LightsWords& w) {
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the results go: -o DIR."};
    if (auto ok = check_folder("--output", w.output); !ok) return ok.error();
    if (!(w.lux_per_unit > 0 && w.lux_per_unit <= 1e12))
        return Error{fmt::format("{:g} is not from above 0 to 1e12", w.lux_per_unit), "--lux-per-unit", ""};
    if (auto ok = check_one_environment(w.environment_files, w.environment); !ok) return ok;
    return check_light_extraction_options(w.options);
}

/// The whole environment as a lat-long, and what turns the world's directions to it.
struct Picture {
    ImageF image;
    Mat3 world_to_source;
};

Result<Picture> read_picture(const Environment& environment, int threads) {
    // A cube has no lat-long convention to keep: the world in the default one.
    if (const Cubemap* cube = environment.cube())
        return Picture{area_resample_cube_to_latlong(*cube, 2 * cube->size(), environment.world_to_source, threads),
                       {}};
    const auto rows = environment.rows();
    if (!rows) return rows.error();
    auto image = read_latlong(**rows);
    if (!image) return image.error();
    return Picture{*std::move(image), environment.world_to_source};
}

Json array(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json light_json(const ExtractedLight& l) {
    Json json{{"direction", array(l.direction)},
              {"azimuth_deg", std::atan2(l.direction.z, l.direction.x) * 180 / k_pi},
              {"elevation_deg", std::atan2(l.direction.y, std::hypot(l.direction.x, l.direction.z)) * 180 / k_pi},
              {"u", l.u},
              {"v", l.v},
              {"angular_diameter_deg", l.angular_diameter_deg},
              {"resolved", l.resolved},
              {"irradiance", array(l.irradiance)},
              {"mean_radiance", array(l.mean_radiance)},
              {"colour", array(l.colour)},
              {"share", l.share},
              {"contrast", nullptr},
              {"texels", l.texels}};
    if (std::isfinite(l.contrast)) json["contrast"] = l.contrast;  // null: in front of black
    return json;
}

struct Outcome {
    std::string name, source_sha256, remainder_file, remainder_sha256;
    const Environment& environment;
    const Picture& picture;
    const LightExtraction& found;
    bool in_openexr_convention = false;  ///< the remainder, as its source was

    /// Whether the remainder is the source's picture, which a reader turns as the source was turned. That of a cube is
    /// in the world's own orientation.
    bool keeps_orientation() const { return environment.projection != "cube"; }
};

Json document(const LightsWords& w, const Outcome& o) {
    const LightExtractionReport& r = o.found.report;
    const LightExtractionOptions& e = w.options;
    Json lights = Json::array();
    for (const ExtractedLight& light : o.found.lights) lights.push_back(light_json(light));
    Json source{{"file", o.name}};
    if (!o.source_sha256.empty()) source["sha256"] = o.source_sha256;
    source.update({{"width", o.environment.width},
                   {"height", o.environment.height},
                   {"projection", o.environment.projection},
                   {"repaired", o.environment.report().repaired()}});
    const Mat3& m = o.picture.world_to_source;
    return {{"version", version()},
            {"source", source},
            {"options",
             {{"max_lights", e.max_lights},
              {"least_share", e.least_share},
              {"least_contrast", e.least_contrast},
              {"largest_diameter_deg", e.largest_diameter_deg},
              {"merge_deg", e.merge_deg},
              {"exposure", w.environment.exposure},
              {"rotate_y_deg", w.environment.rotate_y_deg},
              {"up", w.environment.up},
              {"latlong", w.environment.latlong},
              {"lux_per_unit", w.lux_per_unit}}},
            {"lights", lights},
            {"remainder",
             {{"file", o.remainder_file},
              {"sha256", o.remainder_sha256},
              {"width", o.picture.image.width()},
              {"height", o.picture.image.height()},
              {"world_to_source", Json::array({array(m.row[0]), array(m.row[1]), array(m.row[2])})}}},
            {"power",
             {{"original", array(r.original_power)},
              {"lights", array(r.light_power)},
              {"remainder", array(r.remainder_power)},
              {"unaccounted", r.unaccounted}}},
            {"candidates", r.candidates},
            {"left_out", r.left_out},
            {"texel_deg", r.texel_deg}};
}

Result<void> write_remainder(const std::filesystem::path& file, const Outcome& o, bool hdr, int threads) {
    if (hdr) return write_hdr(file, o.found.remainder.view(), threads);
    ExrWriteOptions exr;
    exr.half = false;
    exr.threads = threads;
    if (o.in_openexr_convention) exr.envmap = "latlong";
    return write_exr(file, o.found.remainder.view(), exr);
}

/// Writes everything into the folder; fills in the remainder's name and hash.
Result<Json> write_all(const LightsWords& w, Outcome& o) {
    const int threads = w.common.threads.value_or(0);
    const bool hdr = w.format == "hdr" || (w.format == "auto" && o.environment.format == "Radiance HDR");
    o.remainder_file = hdr ? "remainder.hdr" : "remainder.exr";
    auto staging = Staging::open(w.output, o.environment.files);
    if (!staging) return staging.error();
    const auto remainder = staging->stage(o.remainder_file);
    if (auto ok = write_remainder(remainder, o, hdr, threads); !ok) return ok.error();
    auto hash = sha256_file(remainder);
    if (!hash) return hash.error();
    o.remainder_sha256 = *hash;
    if (!w.no_preview) {
        const auto sheet = lights_sheet({o.name, o.picture.image.view(), o.found.remainder.view(),
                                         o.picture.world_to_source, o.found.lights, 1600, threads});
        if (auto ok = write_png(staging->stage("preview.png"), sheet.view()); !ok) return ok.error();
    }
    const double turned_deg = o.keeps_orientation() ? w.environment.rotate_y_deg : 0;
    const std::string gltf =
        gltf_lights(o.found.lights, w.lux_per_unit, turned_deg, fmt::format("domelight {}", version()));
    if (auto ok = write_file_atomically(staging->stage("lights.gltf"), gltf); !ok) return ok.error();
    Json json = document(w, o);
    if (auto ok = write_file_atomically(staging->stage("lights.json"), json.dump(2) + "\n"); !ok) return ok.error();
    if (auto ok = staging->commit("lights.json"); !ok) return ok.error();
    return json;
}

void print_summary(const LightsWords& w, const Outcome& o) {
    const LightExtractionReport& r = o.found.report;
    for (std::size_t i = 0; i < o.found.lights.size(); ++i) {
        const ExtractedLight& l = o.found.lights[i];
        print(
            "  light {:<3} {:5.1f} % of the luminance, direction ({:.4f}, {:.4f}, {:.4f}), {}{:.2g} degrees across, "
            "irradiance {:.4g} {:.4g} {:.4g}\n",
            i + 1, 100 * l.share, l.direction.x, l.direction.y, l.direction.z, l.resolved ? "" : "under ",
            l.angular_diameter_deg, l.irradiance.x, l.irradiance.y, l.irradiance.z);
    }
    if (o.found.lights.empty()) print("  no light stands out\n");
    if (r.left_out)
        print("  {} {} in the remainder\n", r.left_out,
              o.found.lights.empty() ? (r.left_out == 1 ? "small bright place is too weak and stays"
                                                        : "small bright places are too weak and stay")
              : r.left_out == 1      ? "weaker one stays"
                                     : "weaker ones stay");
    print("{}: lights.json, lights.gltf, {}{}; lights and remainder have the power of the original to {:.1g}\n",
          w.output, o.remainder_file, w.no_preview ? "" : ", preview.png", r.unaccounted);
}

int run(const LightsWords& w) {
    const std::string name = w.environment_files.empty() ? "built-in sky" : w.environment_files[0];
    EnvironmentOptions reading = w.environment;
    reading.threads = w.common.threads.value_or(0);
    auto environment = open_light_to_draw_from(w.environment_files, reading);
    if (!environment) return print_error(environment.error());
    auto picture = read_picture(*environment, reading.threads);
    if (!picture) return print_error(picture.error().at(name));
    auto found = extract_lights(picture->image.view(), w.options, picture->world_to_source);
    if (!found) return print_error(found.error().at(name));
    const auto hash = environment_sha256(*environment);
    if (!hash) return print_error(hash.error());
    Outcome outcome{std::filesystem::path(name).filename().string(), *hash, "", "", *environment, *picture, *found};
    outcome.in_openexr_convention = environment->convention == "openexr";
    const auto json = write_all(w, outcome);
    if (!json) return print_error(json.error());
    print_warnings(environment->report().lines(), w.common, name);
    if (outcome.in_openexr_convention && outcome.remainder_file == "remainder.hdr" && w.environment.latlong.empty())
        print_warnings({"the remainder is in OpenEXR's lat-long convention, which an .hdr file cannot state: read it "
                        "with --latlong openexr"},
                       w.common, name);
    if (found->report.texel_deg > w.options.largest_diameter_deg)
        print_warnings({fmt::format("texels {:.2g} degrees wide are too coarse to hold a light: none was looked for",
                                    found->report.texel_deg)},
                       w.common, name);
    if (w.common.json)
        print_document(*json);
    else if (!w.common.quiet)
        print_summary(w, outcome);
    return exit_done;
}

}  // namespace

int run_lights(const std::vector<std::string>& words) {
    LightsWords w;
    Arguments arguments(
        "lights",
        "Extracts the sun and other small bright sources from an environment: writes directional lights as JSON and "
        "glTF (KHR_lights_punctual), and the environment without them. No light is lost or counted twice.",
        {"domelight lights studio.hdr -o lights", "domelight lights studio.hdr -o sun --max-lights 1 --format exr",
         "domelight lights -o sky --lux-per-unit 179 --json"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    w.options.max_lights = w.max_lights.value_or(w.options.max_lights);
    w.options.threads = w.common.threads.value_or(0);
    if (auto ok = check(w); !ok) return print_error(ok.error(), exit_usage);
    if (auto ok = check_output_folder(w.output); !ok) return print_error(ok.error());
    return run(w);
}

}  // namespace domelight::cli
