#include "domelight/base/version.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/study/environment_survey.h"
#include "domelight/texture/texture.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "cli/console/vector_json.h"
#include "cli/info/info_probes.h"
#include "cli/info/info_scene.h"
#include "compare/picture_survey.h"
#include "convert/converted_files.h"
#include "io/file/json.h"
#include "io/file/path_inside.h"
#include "io/file/sha256.h"
#include "probe/probe_record.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

namespace fs = std::filesystem;

struct InfoWords {
    CommonOptions common;
    std::vector<std::string> inputs;
    EnvironmentOptions environment;
    bool picture = false;
};

const char* const k_axes[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

std::string rgb(const Vec3d& v) {
    return fmt::format("{:9.4g} {:9.4g} {:9.4g}", v.x, v.y, v.z);
}

/// Values of keys may be anything in other tools' files: one line, not too long.
std::string shown(std::string value) {
    std::replace(value.begin(), value.end(), '\n', ' ');
    const std::string line = printable(value, 200);
    return line.size() < escaped(value).size() ? line + "..." : line;
}

// --- an environment ---

Json environment_json(const std::string& name, const Environment& e, const EnvironmentSurvey& s) {
    Json irradiance = Json::object(), lights = Json::array();
    for (int f = 0; f < 6; ++f) irradiance[k_axes[f]] = vector_json(s.irradiance[f]);
    for (const BrightLight& light : s.lights)
        lights.push_back({{"direction", vector_json(light.direction)},
                          {"azimuth_deg", light.azimuth_deg},
                          {"elevation_deg", light.elevation_deg},
                          {"radius_deg", light.radius_deg},
                          {"share", light.share}});
    const RepairReport r = e.report();
    return {{"version", version()},
            {"kind", "environment"},
            {"file", name},
            {"format", e.format},
            {"layer", e.layer},
            {"projection", e.projection},
            {"width", e.width},
            {"height", e.height},
            {"range", Json::array({s.least, s.largest})},
            {"mean_radiance", vector_json(s.mean_radiance)},
            {"irradiance", irradiance},
            {"lights", lights},
            {"repaired",
             {{"not_a_number", r.not_a_number},
              {"infinite", r.infinite},
              {"negative", r.negative},
              {"most_negative", r.negative_radiance},
              {"light_added", vector_json(r.share_added())}}},
            {"warnings", with_options(r.warnings)}};
}

void print_environment(const std::string& name, const Environment& e, const EnvironmentSurvey& s) {
    print("{}: {}, {} x {}, {}\n", name, e.format, e.width, e.height, e.projection);
    if (!e.layer.empty()) print("  layer            {}\n", shown(e.layer));
    print("  range            {:.6g} to {:.6g}\n", s.least, s.largest);
    print("  mean radiance    {}   (red, green, blue)\n", rgb(s.mean_radiance));
    for (int f = 0; f < 6; ++f) print("  irradiance {}    {}\n", k_axes[f], rgb(s.irradiance[f]));
    for (const BrightLight& l : s.lights)
        print(
            "  bright light     {:4.1f} % of the luminance, direction ({:.3f}, {:.3f}, {:.3f}): azimuth (from +X "
            "towards +Z) {:.1f}, elevation {:.1f} degrees, {:.2g} degrees across\n",
            100 * l.share, l.direction.x, l.direction.y, l.direction.z, l.azimuth_deg, l.elevation_deg,
            2 * l.radius_deg);
    if (s.lights.empty()) print("  bright light     none stands out\n");
    const RepairReport r = e.report();
    const Vec3d added = r.share_added() * 100;
    if (r.repaired())
        print(
            "  bad texels       {} not a number, {} infinite, {} negative (down to {:.4g}){}; repaired on reading, "
            "which "
            "changed the light by {:+.3g} % red, {:+.3g} % green, {:+.3g} % blue\n",
            r.not_a_number, r.infinite, r.negative, r.negative_radiance, r.negatives_kept ? ", kept" : "", added.x,
            added.y, added.z);
    else
        print("  bad texels       none\n");
}

int info_environment(const InfoWords& w) {
    const std::string name = w.inputs.empty() ? "built-in sky" : w.inputs[0];
    EnvironmentOptions options = w.environment;
    options.threads = w.common.threads.value_or(0);
    auto environment = open_environment_or_sky(w.inputs, options);
    if (!environment) return print_error(environment.error());
    Result<EnvironmentSurvey> survey = Error{};
    {
        ProgressBar bar(name, w.common);
        survey = survey_environment(*environment, options.threads, bar.callback());
    }
    if (!survey) return print_error(survey.error().at(name));
    print_warnings(environment->report().warnings, w.common, name);
    if (w.common.json)
        print_document(environment_json(name, *environment, *survey));
    else
        print_environment(name, *environment, *survey);
    return exit_done;
}

// --- a picture ---

/// Whether the file is described as a picture: because that was asked for, or because its shape or its layers rule out
/// an environment. A pipe cannot be read twice, and is taken for an environment.
bool is_picture(const InfoWords& w, const Arguments& a) {
    if (w.picture) return true;
    for (const char* option : {"--projection", "--latlong", "--faces", "--face-orientation", "--rotate-y-deg", "--up"})
        if (a.given(option)) return false;
    if (!w.environment.layer.empty()) return true;
    std::error_code failure;
    if (!fs::is_regular_file(w.inputs[0], failure)) return false;
    return is_picture_of_its_own(w.inputs[0]);
}

/// Names in brackets as `compare --layer` takes them.
std::vector<std::string> named_layers(const PictureFacts& facts) {
    std::vector<std::string> names;
    for (const std::string& layer : facts.layers) names.push_back(layer.empty() ? "(unnamed)" : shown(layer));
    return names;
}

/// For pictures whose shape is that of an environment, as renders of every direction are.
void print_how_to_describe_as_environment(int width, int height) {
    if (width == height)
        print(
            "  environment      where it is one, say which: --projection sphere-map, mirror-ball/fov=DEGREES, "
            "angular, octahedral, ...\n");
    else if (width == 2 * height)
        print("  environment      where it is one, --projection latlong describes its light\n");
    else if (height == 6 * width || width == 6 * height)
        print("  environment      where it is one, --projection cube describes its light\n");
}

void print_picture(const std::string& file, const PictureFacts& facts, const Picture& picture, const PictureSurvey& s) {
    print("{}: {}, {} x {}, a picture\n", file, facts.format, picture.rgb.width(), picture.rgb.height());
    if (!facts.layers.empty()) print("  layers           {}\n", join(named_layers(facts), ", "));
    if (!picture.layer.empty()) print("  layer            {}\n", shown(picture.layer));
    print("  range            {:.6g} to {:.6g}\n", s.least, s.largest);
    print("  mean             {}   (red, green, blue)\n", rgb(s.mean));
    print("  exposure         {:+.2f} stops suit a screen\n", s.ev);
    if (!picture.opacity.empty())
        print("  opacity          {:.1f} % of the picture is covered{}\n", 100 * s.coverage,
              s.coverage == 1 ? ""
              : s.cut_out     ? ", the rest is transparent"
                              : ", and the background shows in the rest");
    if (s.not_a_number + s.infinite + s.negative > 0)
        print("  bad pixels       {} not a number, {} infinite, {} negative\n", s.not_a_number, s.infinite, s.negative);
    else
        print("  bad pixels       none\n");
    print_how_to_describe_as_environment(picture.rgb.width(), picture.rgb.height());
}

Json picture_json(const std::string& file, const PictureFacts& facts, const Picture& picture, const PictureSurvey& s) {
    Json json{{"version", version()},
              {"kind", "picture"},
              {"file", file},
              {"format", facts.format},
              {"width", picture.rgb.width()},
              {"height", picture.rgb.height()},
              {"layer", picture.layer},
              {"layers", facts.layers},
              {"channels", facts.channels},
              {"range", Json::array({s.least, s.largest})},
              {"mean", vector_json(s.mean)},
              {"ev", s.ev},
              {"bad", {{"not_a_number", s.not_a_number}, {"infinite", s.infinite}, {"negative", s.negative}}},
              {"warnings", with_options(picture.warnings)}};
    if (picture.opacity.empty())
        json["opacity"] = nullptr;
    else
        json["opacity"] = {{"coverage", s.coverage}, {"transparent", s.cut_out}};
    return json;
}

int info_picture(const InfoWords& w) {
    const std::string& file = w.inputs[0];
    const auto facts = read_picture_facts(file);
    if (!facts) return print_error(facts.error());
    PictureOptions options;
    options.layer = w.environment.layer;
    options.opacity = true;
    options.decode = w.environment.decode;
    options.threads = w.common.threads.value_or(0);
    auto picture = read_picture(file, options);
    if (!picture) return print_error(picture.error());
    for (float& v : picture->rgb.pixels()) v *= float(std::exp2(w.environment.exposure));
    const PictureSurvey survey = survey_picture(*picture);
    print_warnings(picture->warnings, w.common, file);
    if (w.common.json)
        print_document(picture_json(file, *facts, *picture, survey));
    else
        print_picture(file, *facts, *picture, survey);
    return exit_done;
}

// --- a texture ---

int info_texture(const std::string& file, const InfoWords& w) {
    const auto info = read_texture_info(file);
    if (!info) return print_error(info.error().at(file));
    if (w.common.json) {
        print_document({{"version", version()},
                        {"kind", "texture"},
                        {"file", file},
                        {"container", info->container},
                        {"format", info->format},
                        {"supercompression", info->supercompression},
                        {"width", info->width},
                        {"height", info->height},
                        {"depth", info->depth},
                        {"faces", info->faces},
                        {"layers", info->layers},
                        {"levels", info->levels},
                        {"metadata", info->metadata},
                        {"decodable", info->decodable}});
        return exit_done;
    }
    print("{}: {}, {}, {} x {}", file, info->container, info->format, info->width, info->height);
    if (info->depth > 1) print(" x {}", info->depth);
    if (info->faces > 1) print(", {} faces", info->faces);
    if (info->layers > 1) print(", {} layers", info->layers);
    print(", {} level{}{}\n", info->levels, info->levels == 1 ? "" : "s",
          info->supercompression.empty() || info->supercompression == "none" ? "" : ", " + info->supercompression);
    for (const auto& [key, value] : info->metadata) print("  {:<24} {}\n", shown(key), shown(value));
    if (info->faces == 6 && info->layers <= 1 && info->decodable) print("  --projection cube describes its light\n");
    return exit_done;
}

// --- a bake ---

/// Every file that a manifest names, with the hash it should have.
void list_files(const Json& json, std::vector<std::pair<std::string, std::string>>& files, int depth = 0) {
    if (depth > 16 || !json.is_structured()) return;
    if (json.is_object() && json.contains("file") && json["file"].is_string() && json.contains("sha256"))
        files.emplace_back(json["file"].get<std::string>(),
                           json["sha256"].is_string() ? json["sha256"].get<std::string>() : "");
    for (const auto& [key, value] : json.items()) list_files(value, files, depth + 1);
    for (const Json& element : json.elements()) list_files(element, files, depth + 1);
}

std::string file_state(const fs::path& folder, const std::string& name, const std::string& expected) {
    std::error_code failure;
    // A bake never lists such names, so nothing is said of what they lead to.
    if (!path_inside(folder / name, folder, name)) return "not in the folder, not read";
    if (!fs::exists(folder / name, failure)) return "missing";
    if (!fs::is_regular_file(folder / name, failure)) return "not a file";
    if (expected.empty()) return "there";
    const auto hash = sha256_in_folder(folder, name);
    return !hash ? "unreadable" : *hash == expected ? "unchanged" : "changed";
}

/// A member's text, whatever it is.
std::string member(const Json& json, const char* key) {
    if (!json.is_object() || !json.contains(key)) return "?";
    const Json& value = json[key];
    return value.is_string() ? value.get<std::string>() : value.is_structured() ? "..." : value.dump();
}

/// The same, with three digits of a number.
std::string rounded_member(const Json& json, const char* key) {
    const bool number = json.is_object() && json.contains(key) && json[key].is_number();
    return number ? fmt::format("{:.3g}", json[key].get<double>()) : member(json, key);
}

void print_levels(const Json& map) {
    if (!map.contains("levels") || !map["levels"].is_array()) return;
    for (const Json& level : map["levels"].elements()) {
        const bool phong = level.is_object() && level.contains("exponent");
        const std::string clipped = rounded_member(level, "clipped_energy");
        print("    level {:<3} size {:<6} {} {:<10} {}\n", member(level, "level"), member(level, "size"),
              phong ? "exponent" : "roughness", rounded_member(level, phong ? "exponent" : "roughness"),
              clipped == "0" ? "nothing clipped" : "clipped energy " + clipped);
    }
}

int info_bake(const fs::path& folder, const InfoWords& w) {
    const fs::path file = folder / "manifest.json";
    const auto parsed = Json::read(file);
    if (!parsed) return print_error(parsed.error());
    const Json& manifest = *parsed;
    if (!manifest.is_object() || !manifest.contains("source") || !manifest.contains("options"))
        return print_error({"is not a manifest that a bake wrote", file.string(), ""});
    std::vector<std::pair<std::string, std::string>> files;
    for (const auto& [key, value] : manifest.items())
        if (key != "source") list_files(value, files);
    Json states = Json::array();
    bool whole = true;
    for (const auto& [name, hash] : files) {
        const std::string state = file_state(folder, name, hash);
        whole = whole && (state == "unchanged" || state == "there");
        states.push_back({{"file", name}, {"state", state}});
    }
    if (w.common.json) {
        print_document({{"version", version()},
                        {"kind", "bake"},
                        {"folder", folder.string()},
                        {"files", states},
                        {"manifest", manifest}});
        return whole ? exit_done : exit_failed;
    }
    const Json& source = manifest["source"];
    print("{}: baked by domelight {} from {} ({} x {}, {}) for {}\n", folder.string(), member(manifest, "version"),
          member(source, "file"), member(source, "width"), member(source, "height"), member(source, "projection"),
          member(manifest["options"], "for"));
    for (const auto& [role, map] : manifest.items())
        if (map.is_object() && map.contains("quantity") && map.contains("encoding")) {
            print("  {}: {}, {}, {}\n", role, member(map, "quantity"), member(map, "encoding"), member(map, "layout"));
            if (member(map, "quantity") == "radiance") print_levels(map);
        }
    for (const Json& state : states.elements()) print("  {:<28} {}\n", member(state, "file"), member(state, "state"));
    return whole ? exit_done : print_error({"not all files are as they were written", folder.string(), "Bake again."});
}

}  // namespace

int run_info(const std::vector<std::string>& words) {
    InfoWords w;
    Arguments arguments(
        "info",
        "Describes an environment (size, projection, range, mean radiance, irradiance by direction, "
        "brightest lights, bad texels), any other picture (layers, range, exposure, opacity, bad pixels), "
        "a texture (KTX2, KTX, DDS, from any tool), a scene (size, materials, cameras, lights), or the folder of a "
        "bake "
        "or of a set of probes.",
        {"domelight info studio.hdr", "domelight info studio.hdr --json", "domelight info out",
         "domelight info out/specular.ktx2", "domelight info ball"});
    arguments.positional(
        "ENV|FILE|FOLDER", w.inputs,
        fmt::format(
            "an environment, any other picture, a texture, a scene, a bake, or a set of probes; without one, {}",
            k_built_in_sky));
    arguments.group("Pictures");
    arguments.flag(
        "--picture", w.picture,
        "describe it as a picture, not as an environment. Without this option that is done for a file whose shape or "
        "layers are not an environment's");
    add_environment_options(arguments, w.environment);
    add_common_options(arguments, w.common);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (w.inputs.size() == 1) {
        const fs::path input = w.inputs[0];
        std::error_code failure;
        if (fs::exists(input / "manifest.json", failure)) return info_bake(input, w);
        if (input.filename() == "manifest.json" && fs::exists(input, failure)) return info_bake(input.parent_path(), w);
        if (fs::exists(input / k_probes_json, failure)) return info_probes(input, w.common);
        if (input.filename() == k_probes_json && fs::exists(input, failure))
            return info_probes(input.parent_path(), w.common);
        if (has_texture_ending(input.string()) && !arguments.given("--projection"))
            return info_texture(input.string(), w);
        if (may_be_scene(input.string()) && !arguments.given("--projection")) {
            SceneOptions options;
            options.threads = w.common.threads.value_or(0);
            if (const auto scene = open_scene(input.string(), options))
                return info_scene(input.string(), *scene, w.common);
            // A .gltf without triangles may be an environment of EXT_lights_image_based.
            else if (!open_environment({input}, {}))
                return print_error(scene.error());
        }
        if (is_picture(w, arguments)) return info_picture(w);
    } else if (w.picture) {
        return print_error({fmt::format("goes with one picture, not with {} files", w.inputs.size()), "--picture", ""});
    } else if (auto ok = check_one_environment(w.inputs, w.environment); !ok) {
        return print_error(ok.error(), exit_usage);
    }
    return info_environment(w);
}

}  // namespace domelight::cli
