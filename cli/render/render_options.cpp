#include "cli/render/render_options.h"

#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include "cli/console/output_endings.h"
#include "preview/tonemap.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace domelight::cli {
namespace {

Result<void> check_numbers(const RenderWords& w) {
    for (const auto& [option, value] : {std::pair{"--width", w.width}, {"--height", w.height}})
        if (auto ok = within(option, value.value_or(512), 1, 16384); !ok) return ok;
    const struct {
        const char* option;
        double value, low, high;
    } ranges[] = {{"--spp", double(w.spp.value_or(64)), 1, 1 << 20},
                  {"--bounces", double(w.bounces.value_or(4)), 0, 1000},
                  {"--lookup-size", double(w.lookup_size.value_or(512)), 1, 8192},
                  {"--probe-blend", double(w.probe_blend.value_or(8)), 1, 8},
                  {"--probe-offset", w.probe_offset, 0, 1},
                  {"--fov-deg", w.fov_deg, 0.1, 170},
                  {"--noise", w.noise, 0, 1},
                  {"--time", w.time, 0, 1e6},
                  {"--ev", std::isnan(w.ev) ? 0 : w.ev, -100, 100},
                  {"--background-roughness", w.background_roughness, 0, 1},
                  {"--save-every", w.save_every, 0, 1e6},
                  {"--lux-per-unit", w.lux_per_unit, 1e-12, 1e12},
                  {"--frames", double(w.frames.value_or(60)), 2, 9999},
                  {"--fps", w.fps, 1, 1000}};
    for (const auto& r : ranges)
        if (auto ok = within(r.option, r.value, r.low, r.high); !ok) return ok;
    for (const auto& [option, value] :
         {std::pair{"--camera-position", &w.camera_position}, {"--camera-target", &w.camera_target}}) {
        if (!value->empty() && value->size() != 3) return Error{"needs three numbers", option, "x,y,z"};
        for (const double v : *value)
            if (!(std::abs(v) <= 1e9))
                return Error{fmt::format("{:g} is not finite and within 1e9 metres", v), option, "x,y,z"};
    }
    return {};
}

Result<void> check_outputs(RenderWords& w) {
    std::vector<std::string> outputs;
    for (const std::string& o : w.outputs)
        for (const std::string& part : split(o, ',')) outputs.push_back(part);
    w.outputs = std::move(outputs);
    if (w.outputs.empty()) return Error{"is missing", "--output", "Say where the picture goes: -o picture.png."};
    if (w.study) {
        const std::string& output = w.outputs[0];
        if (w.outputs.size() > 1 || (!lower_case_extension(output).empty() && !is_screen_picture(output)))
            return Error{fmt::format("\"{}\" is neither a folder nor a .png or .jpg", join(w.outputs, ",")), "--output",
                         "A study goes into a folder, or onto one sheet: -o DIR or -o study.png."};
        return {};
    }
    for (const std::string& o : w.outputs)
        if (auto ok = check_ending("--output", o, light_and_screen_endings()); !ok) return ok;
    return {};
}

/// Which options need which others.
Result<void> check_company(const RenderWords& w, const Arguments& a) {
    const auto needs = [&](const char* option, bool fine, const char* what) -> Result<void> {
        if (!a.given(option) || fine) return {};
        return Error{std::string("goes with ") + what + " only", option, ""};
    };
    const bool blurred = w.backdrop == Background::blurred, colour = w.backdrop == Background::colour;
    const struct {
        const char* option;
        bool fine;
        const char* what;
    } rules[] = {{"--background-roughness", blurred, "--background blurred"},
                 {"--camera-target", !w.camera_position.empty(), "--camera-position"},
                 {"--probes",
                  w.shading == ShadingModel::split_sum || w.shading == ShadingModel::stretched ||
                      w.shading == ShadingModel::phong,
                  "--shading split-sum, stretched or phong"},
                 {"--parallax", !w.probes.empty(), "--probes"},
                 {"--probe-blend", !w.probes.empty(), "--probes"},
                 {"--probe-visibility", !w.probes.empty(), "--probes"},
                 {"--probe-offset", !w.probes.empty(), "--probes"},
                 {"--fps", w.frames.has_value(), "--frames"},
                 {"--turn", w.frames.has_value(), "--frames"},
                 {"--resume", w.frames.has_value(), "--frames"},
                 {"--diffuse-weight", w.shading == ShadingModel::split_sum || w.shading == ShadingModel::stretched,
                  "--shading split-sum or stretched"},
                 {"--save-every", w.reference() && !w.frames && !w.study, "a single picture of --shading reference"}};
    // Arguments::given does not look for this spelling of the option.
    if (!w.background_color.empty() && !colour)
        return Error{"goes with --background colour only", "--background-color", ""};
    for (const auto& rule : rules)
        if (auto ok = needs(rule.option, rule.fine, rule.what); !ok) return ok;
    if (w.backdrop == Background::transparent)
        for (const std::string& o : w.outputs)
            if (is_screen_picture(o) && !holds_opacity(o))
                return Error{fmt::format("\"{}\" cannot be transparent: JPEG holds no opacity", o), "--output",
                             "Write a .png, or choose another --background."};
    if (w.panorama() != Camera::Panorama::none) {
        for (const char* option : {"--camera-target", "--fov-deg", "--frames", "--shadow-catcher"})
            if (a.given(option)) return Error{"has no meaning with --camera " + w.camera, option, ""};
        if (w.panorama() == Camera::Panorama::cube && a.given("--height"))
            return Error{"has no meaning with --camera cube", "--height",
                         "--width N is the size of a face; the six faces lie one below the other."};
        if (w.panorama() == Camera::Panorama::latlong && w.width && w.height && *w.width != 2 * *w.height)
            return Error{"is not half of --width", "--height", "A lat-long map is twice as wide as high."};
    } else if (!w.camera.empty() && !w.camera_position.empty()) {
        return Error{"is one camera, --camera-position another", "--camera", "Leave one of them out."};
    }
    if (w.turn == "environment" && !w.maps.empty())
        return Error{"turns the light, and the maps of --maps would stay as they are", "--turn",
                     "Leave --maps out: each frame then bakes its own."};
    if (w.turn == "environment" && !w.probes.empty())
        return Error{"turns the light, and the probes of --probes would stay as they are", "--turn", ""};
    if (!w.probes.empty() && !w.maps.empty())
        return Error{"is the light of one environment, --probes that of a room", "--maps", "Leave one of them out."};
    if (w.study)
        for (const char* option : {"--frames", "--shadow-catcher", "--background", "--shading", "--strategy", "--maps",
                                   "--probes", "--lights"})
            if (a.given(option)) return Error{"has no meaning with --study, which draws them all", option, ""};
    return {};
}

}  // namespace

Result<Vec3f> parse_colour(const std::string& text) {
    const Error wrong{fmt::format("\"{}\" is not a colour", text), "", "Accepted: #rrggbb (sRGB), or R,G,B (linear)."};
    if (text.starts_with("#")) {
        unsigned value = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data() + 1, end, value, 16);
        if (text.size() != 7 || code != std::errc() || stop != end) return wrong;
        const auto channel = [&](int shift) { return srgb_decode(float(value >> shift & 255) / 255); };
        return Vec3f{channel(16), channel(8), channel(0)};
    }
    const auto words = split(text, ',');
    double v[3] = {};
    if (words.size() != 3) return wrong;
    for (int i = 0; i < 3; ++i) {
        const auto number = parse_number(words[std::size_t(i)]);
        if (!number || !(*number >= 0 && *number <= 1e6)) return wrong;
        v[i] = *number;
    }
    return Vec3f(Vec3d{v[0], v[1], v[2]});
}

Result<void> check_words(RenderWords& w, const Arguments& a) {
    if (w.scenes.size() > 1 || (w.scenes.empty() && !w.study))
        return Error{w.scenes.empty() ? "is missing" : "is given twice", "SCENE",
                     fmt::format("One model, or a built-in scene: {}.", join(built_in_scene_names(), ", "))};
    if (auto ok = check_outputs(w); !ok) return ok;
    if (auto ok = check_numbers(w); !ok) return ok;
    w.backdrop = w.background.value_or(w.background_color.empty() ? Background::environment : Background::colour);
    if (w.backdrop == Background::colour) {
        const auto colour = parse_colour(w.background_color.empty() ? "#ffffff" : w.background_color);
        if (!colour) return colour.error().at("--background-color");
        w.backdrop_colour = *colour;
    }
    return check_company(w, a);
}

std::string camera_list(const Scene& scene) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const std::string& name = scene.cameras[i].name;
        names.push_back(name.empty() ? std::to_string(i + 1) : fmt::format("{} \"{}\"", i + 1, name));
    }
    return join(names, ", ");
}

namespace {

/// Finds a camera by its number, counted from 1, or by its name.
Result<const Camera*> find_camera(const std::string& word, const Scene& scene) {
    for (const Camera& c : scene.cameras)
        if (c.name == word) return &c;
    const auto number = parse_integer(word);
    if (number && *number >= 1 && *number <= int(scene.cameras.size())) return &scene.cameras[std::size_t(*number - 1)];
    return Error{fmt::format("the scene has no camera \"{}\"", word), "--camera",
                 scene.cameras.empty() ? "It has none at all: give --camera-position."
                                       : fmt::format("It has {}.", camera_list(scene))};
}

Vec3f vector(const std::vector<double>& v) {
    return v.empty() ? Vec3f{} : Vec3f(Vec3d{v[0], v[1], v[2]});
}

/// Sets a camera that sees in every direction, and the size of its picture.
void set_panorama(RenderOptions& o, const RenderWords& w, const Scene& scene) {
    o.camera.panorama = w.panorama();
    const Scene::Box box = scene.bounds();
    o.camera.to_world.translation = w.camera_position.empty() ? (box.low + box.high) * 0.5f : vector(w.camera_position);
    if (o.camera.panorama == Camera::Panorama::cube) {
        o.width = w.width.value_or(256);
        o.height = 6 * o.width;
    } else {
        o.height = w.height ? *w.height : w.width ? std::max(1, *w.width / 2) : 512;
        o.width = 2 * o.height;
    }
}

/// Sets the camera that was asked for, or the scene's, and the size of the picture.
Result<void> set_camera(RenderOptions& o, const RenderWords& w, const Scene& scene) {
    const Camera* own = scene.cameras.empty() ? nullptr : &scene.cameras.front();
    if (!w.camera.empty()) {
        const auto found = find_camera(w.camera, scene);
        if (!found) return found.error();
        own = *found;
    }
    SceneView view{w.width, w.height, own, {}, vector(w.camera_target), float(w.fov_deg * k_pi / 180)};
    if (!w.camera_position.empty()) view.eye = vector(w.camera_position);
    set_view(o, scene, view);
    return {};
}

}  // namespace

Result<RenderOptions> render_options(const RenderWords& w, const Scene& scene) {
    RenderOptions o;
    if (w.panorama() != Camera::Panorama::none)
        set_panorama(o, w, scene);
    else if (auto ok = set_camera(o, w, scene); !ok)
        return ok.error();
    o.strategy = w.strategy;
    o.samples = w.spp.value_or(64);
    o.noise = w.noise;
    o.seconds = w.time;
    o.bounces = w.bounces.value_or(4);
    o.occlusion = w.occlusion;
    o.multiple_scattering = w.multiple_scattering;
    o.background = w.backdrop;
    o.background_colour = w.backdrop_colour;
    o.background_roughness = float(w.background_roughness);
    o.seed = std::uint64_t(w.seed.value_or(0));
    o.threads = w.threads();
    return o;
}

}  // namespace domelight::cli
