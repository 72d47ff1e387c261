#include "domelight/bake.h"
#include "domelight/colour.h"
#include "domelight/image_io.h"
#include "domelight/render.h"
#include "domelight/shading.h"

#include "commands.h"
#include "console.h"
#include "environment_options.h"
#include "preview/tonemap.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace domelight::cli {
namespace {

struct RenderWords {
    CommonOptions common;
    std::vector<std::string> scenes, environment_files, outputs;
    EnvironmentOptions environment;
    std::string shading = "reference", strategy = "mis", occlusion = "on", background = "environment", maps,
                tonemap = "agx", irradiance = "cube";
    std::optional<int> width, height, spp, bounces, seed;
    std::vector<double> camera_position, camera_target;
    double fov_deg = 35, noise = 0, time = 0, ev = std::numeric_limits<double>::quiet_NaN();
    bool multiple_scattering = false, bent_lookup = false;
};

void declare(Arguments& a, RenderWords& w) {
    a.positional("SCENE", w.scenes,
                 "a model (.glb, .gltf, .obj, .ply), or one that is built in: spheres, ball, furnace");
    a.group("The picture");
    a.texts("-o,--output", "FILE", w.outputs,
            "where to write it, several allowed: .exr (all layers), .hdr, .png (tone mapped)");
    a.integer("--width", "N", w.width, "pixels (512)");
    a.integer("--height", "N", w.height, "pixels (512)");
    a.numbers("--camera-position", "x,y,z", w.camera_position,
              "the eye (the scene's camera, or one that shows all of it)");
    a.numbers("--camera-target", "x,y,z", w.camera_target, "what it looks at (0,0,0)");
    a.number("--fov-deg", "DEGREES", w.fov_deg, "vertical field of view with --camera-position (35)");
    a.choice("--background", w.background, {"environment", "transparent"}, "where no surface is (environment)");
    a.choice("--tonemap", w.tonemap, {"agx", "agx-punchy", "neutral", "none"}, "of a .png (agx)");
    a.number("--ev", "STOPS", w.ev, "exposure of a .png (from the picture's log-average luminance)");
    a.group("The light");
    a.texts("--env", "ENV", w.environment_files, "the environment (the built-in sky)");
    add_environment_options(a, w.environment);
    a.group("How it is computed");
    a.choice("--shading", w.shading, {"reference", "split-sum", "phong", "mirror", "refract"},
             "reference = path tracing; the others as a real-time engine draws them from baked maps (reference)");
    a.choice("--strategy", w.strategy, {"mis", "env", "brdf"}, "reference: where light directions come from (mis)");
    a.integer("--spp", "N", w.spp, "samples of each pixel (64)");
    a.number("--noise", "X", w.noise,
             "reference: more samples where a pixel's standard error of L/(1+L) is above this");
    a.number("--time", "SECONDS", w.time, "reference: as many samples as fit into this time");
    a.integer("--bounces", "N", w.bounces, "reference: of indirect light; 0 is direct light with shadows (4)");
    a.choice("--occlusion", w.occlusion, {"on", "off"},
             "off: no shadows, no indirect light, no occlusion maps, as a shader without them (on)");
    a.flag("--multiple-scattering", w.multiple_scattering, "gives back what single scattering loses on rough surfaces");
    a.text("--maps", "DIR", w.maps, "split-sum, phong: what `domelight bake` wrote (baked in memory)");
    a.choice("--irradiance", w.irradiance, {"cube", "sh"},
             "split-sum, phong: the irradiance cube, or nine harmonics (cube)");
    a.flag("--bent-lookup", w.bent_lookup, "split-sum: the lookup leans towards the normal on rough surfaces");
    a.integer("--seed", "N", w.seed, "another randomisation (0)");
    add_common_options(a, w.common);
}

Result<void> check(const RenderWords& w) {
    if (w.scenes.size() != 1)
        return Error{w.scenes.empty() ? "is missing" : "is given twice", "SCENE",
                     "One model, or spheres, ball or furnace."};
    if (w.outputs.empty()) return Error{"is missing", "--output", "Say where the picture goes: -o picture.png."};
    for (const std::string& o : w.outputs) {
        const std::string extension = std::filesystem::path(o).extension().string();
        if (extension != ".exr" && extension != ".hdr" && extension != ".png")
            return Error{fmt::format("\"{}\" ends in none of the formats", o), "--output",
                         "Accepted: .exr, .hdr, .png."};
    }
    const auto within = [](const char* option, double value, double low, double high) -> Result<void> {
        if (value >= low && value <= high) return {};
        return Error{fmt::format("{:g} is not from {:g} to {:g}", value, low, high), option, ""};
    };
    for (const auto& [option, value] : {std::pair{"--width", w.width}, {"--height", w.height}})
        if (auto ok = within(option, value.value_or(512), 1, 16384); !ok) return ok;
    if (auto ok = within("--spp", w.spp.value_or(64), 1, 1 << 20); !ok) return ok;
    if (auto ok = within("--bounces", w.bounces.value_or(4), 0, 1000); !ok) return ok;
    if (auto ok = within("--fov-deg", w.fov_deg, 0.1, 170); !ok) return ok;
    if (auto ok = within("--noise", w.noise, 0, 1); !ok) return ok;
    if (auto ok = within("--time", w.time, 0, 1e6); !ok) return ok;
    for (const auto& [option, value] :
         {std::pair{"--camera-position", &w.camera_position}, {"--camera-target", &w.camera_target}})
        if (!value->empty() && value->size() != 3) return Error{"wants three numbers", option, "x,y,z"};
    return {};
}

bool is_built_in(const std::string& name) {
    return name == "spheres" || name == "ball" || name == "furnace";
}

RenderOptions render_options(const RenderWords& w, const Scene& scene) {
    RenderOptions o;
    o.width = w.width.value_or(512);
    o.height = w.height.value_or(512);
    const auto vector = [](const std::vector<double>& v) {
        return v.empty() ? Vec3f{} : Vec3f(Vec3d{v[0], v[1], v[2]});
    };
    o.camera = w.camera_position.empty()
                   ? default_camera(scene, float(o.width) / float(o.height))
                   : look_at(vector(w.camera_position), vector(w.camera_target), float(w.fov_deg * k_pi / 180));
    o.strategy = w.strategy == "env"    ? LightStrategy::environment
                 : w.strategy == "brdf" ? LightStrategy::brdf
                                        : LightStrategy::mis;
    o.samples = w.spp.value_or(64);
    o.noise = w.noise;
    o.seconds = w.time;
    o.bounces = w.bounces.value_or(4);
    o.occlusion = w.occlusion == "on";
    o.multiple_scattering = w.multiple_scattering;
    o.background = w.background == "transparent" ? Background::transparent : Background::environment;
    o.seed = std::uint64_t(w.seed.value_or(0));
    o.threads = w.common.threads.value_or(0);
    return o;
}

Result<RenderResult> render(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                            const RenderOptions& o) {
    if (w.shading == "reference") return render_reference(scene, sampler, o);
    ShadingOptions shading;
    for (const ShadingModel m :
         {ShadingModel::split_sum, ShadingModel::phong, ShadingModel::mirror, ShadingModel::refract})
        if (shading_model_name(m) == w.shading) shading.model = m;
    shading.sh_irradiance = w.irradiance == "sh";
    shading.bent_lookup = w.bent_lookup;
    shading.multiple_scattering = w.multiple_scattering;
    shading.occlusion = o.occlusion;
    auto maps = w.maps.empty() ? LightMaps::bake(sampler.image(), sampler.world_to_source(), o.threads)
                               : LightMaps::load(w.maps);
    if (!maps) return maps.error();
    return render_shaded(scene, *maps, sampler, shading, o);
}

/// Stops that bring the picture's log-average luminance to 0.18; what shows no surface counts little.
double automatic_ev(const RenderResult& r) {
    double sum = 0, weight = 0;
    for (int y = 0; y < r.radiance.height(); ++y)
        for (int x = 0; x < r.radiance.width(); ++x) {
            const float* p = r.radiance.at(x, y);
            const double w = 0.05 + *r.opacity.at(x, y);
            sum += w * std::log(std::max(1e-6, luminance(p)));
            weight += w;
        }
    return std::log2(0.18 / std::exp(sum / weight));
}

Result<void> write_picture(const std::string& file, const RenderResult& r, const RenderWords& w, double ev) {
    const int width = r.radiance.width(), height = r.radiance.height();
    const bool transparent = w.background == "transparent";
    Image<std::uint8_t> pixels(width, height, transparent ? 4 : 3);
    const Tonemap method = w.tonemap == "none"      ? Tonemap::none
                           : w.tonemap == "neutral" ? Tonemap::neutral
                           : w.tonemap == "agx"     ? Tonemap::agx
                                                    : Tonemap::agx_punchy;
    const Display display{method, float(std::exp2(ev))};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float *p = r.radiance.at(x, y), opacity = *r.opacity.at(x, y);
            Vec3f c{p[0], p[1], p[2]};
            if (transparent && opacity > 0) c = c / opacity;  // PNG's colours are not multiplied with their opacity
            const auto rgb = display.rgb8(c);
            std::uint8_t* q = pixels.at(x, y);
            std::copy(rgb.begin(), rgb.end(), q);
            if (transparent) q[3] = to_byte(std::clamp(opacity, 0.f, 1.f));
        }
    return write_png(file, pixels.view());
}

Result<void> write_layers(const std::string& file, const RenderResult& r, const Scene& scene) {
    const ExrLayer layers[] = {{"", r.radiance, ""},         {"", r.opacity, "A"},         {"direct", r.direct, ""},
                               {"indirect", r.indirect, ""}, {"diffuse", r.diffuse, ""},   {"specular", r.specular, ""},
                               {"albedo", r.albedo, ""},     {"normal", r.normal, ""},     {"depth", r.depth, "Z"},
                               {"object", r.object, "Y"},    {"variance", r.variance, ""}, {"samples", r.samples, "Y"}};
    // `compare` names the objects of its table by it: one a line, from object 1 on.
    ExrWriteOptions options;
    std::string& names = options.attributes["objects"];
    for (const Instance& instance : scene.instances) names += instance.name + "\n";
    return write_exr_layers(file, layers, options);
}

Result<void> write(const std::string& file, const RenderResult& r, const Scene& scene, const RenderWords& w,
                   double ev) {
    const std::string extension = std::filesystem::path(file).extension().string();
    if (extension == ".png") return write_picture(file, r, w, ev);
    if (extension == ".hdr") return write_hdr(file, r.radiance.view(), w.common.threads.value_or(0));
    return write_layers(file, r, scene);
}

void print_result(const RenderWords& w, const Scene& scene, const RenderResult& r, const RenderOptions& o, double ev) {
    const bool reference = w.shading == "reference";
    if (w.common.json) {
        nlohmann::ordered_json json{
            {"version", version()},      {"files", w.outputs},   {"width", o.width},
            {"height", o.height},        {"shading", w.shading}, {"triangles", scene.triangle_count()},
            {"samples", r.sample_count}, {"seconds", r.seconds}, {"ev", ev}};
        if (reference) json["noise"] = r.noise, json["rays"] = r.rays;
        json["warnings"] = scene.warnings;
        fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (!w.common.quiet) {
        fmt::print("{}: {} x {}, {} triangles, {} samples a pixel at most, {:.2f} s", join(w.outputs, ", "), o.width,
                   o.height, scene.triangle_count(), r.sample_count, r.seconds);
        if (reference)
            fmt::print(", noise {:.4f} of L/(1+L), {:.2f} million rays a second", r.noise,
                       double(r.rays) / r.seconds * 1e-6);
        fmt::print("\n");
    }
}

}  // namespace

int run_render(const std::vector<std::string>& words) {
    RenderWords w;
    Arguments arguments(
        "render",
        "Renders a scene under an environment: the truth by path tracing, or what a real-time engine would draw.",
        {"domelight render spheres -o spheres.png --width 256 --height 128 --spp 4",
         "domelight render helmet.glb --env sunset.hdr -o truth.exr,truth.png --spp 256",
         "domelight render ball --env sunset.hdr --shading split-sum -o engine.png"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    std::vector<std::string> outputs;
    for (const std::string& o : w.outputs)
        for (const std::string& part : split(o, ',')) outputs.push_back(part);
    w.outputs = std::move(outputs);
    if (auto ok = check(w); !ok) return print_error(ok.error(), exit_usage);

    SceneOptions scene_options;
    scene_options.threads = w.common.threads.value_or(0);
    auto scene = is_built_in(w.scenes[0]) ? built_in_scene(w.scenes[0]) : load_scene(w.scenes[0], scene_options);
    if (!scene) return print_error(scene.error());
    print_warnings(scene->warnings, w.common, w.scenes[0]);
    print_warnings(not_rendered(*scene), w.common, w.scenes[0]);
    w.environment.threads = w.common.threads.value_or(0);
    auto environment = open_environment_or_sky(w.environment_files, w.environment);
    if (!environment) return print_error(environment.error());

    RenderOptions options = render_options(w, *scene);
    auto traced = RayScene::build(std::move(*scene));
    if (!traced) return print_error(traced.error().at(w.scenes[0]));
    auto sampler =
        EnvironmentSampler::build(*environment, reference_sampler_options(options.strategy, options.threads));
    if (!sampler) return print_error(sampler.error());
    Result<RenderResult> result = Error{"", "", ""};
    {
        ProgressBar bar(w.scenes[0], w.common);
        options.progress = bar.callback();
        result = render(w, *traced, *sampler, options);
    }
    if (!result) return print_error(result.error());
    const double ev = std::isnan(w.ev) ? automatic_ev(*result) : w.ev;
    for (const std::string& o : w.outputs)
        if (auto ok = write(o, *result, traced->scene(), w, ev); !ok) return print_error(ok.error().at(o));
    print_result(w, traced->scene(), *result, options, ev);
    return exit_done;
}

}  // namespace domelight::cli
