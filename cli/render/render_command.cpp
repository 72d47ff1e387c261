#include "domelight/base/version.h"
#include "domelight/io/write_image.h"

#include "cli/commands.h"
#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/interruption.h"
#include "cli/console/light_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "cli/render/render_outputs.h"
#include "cli/render/render_study_command.h"
#include "cli/render/render_turntable.h"
#include "io/file/input_guard.h"
#include "io/file/json.h"
#include "io/file/output_place.h"
#include "preview/tonemap.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

namespace domelight::cli {
namespace {

/// The words of --shading.
std::vector<NamedValue<std::optional<ShadingModel>>> shadings() {
    std::vector<NamedValue<std::optional<ShadingModel>>> rows{{std::nullopt, k_reference}};
    for (const auto& [model, name] : EnumNames<ShadingModel>::table) rows.push_back({model, name});
    return rows;
}

void declare(Arguments& a, RenderWords& w) {
    a.positional("SCENE", w.scenes,
                 "a model (.glb, .gltf, .obj, .ply), or a built-in one: " + join(built_in_scene_names(), ", "));
    a.group("The picture");
    a.texts("-o,--output", "FILE", w.outputs,
            "the output: .exr with all layers, .hdr, or a tone-mapped .png or .jpg; may be given several times");
    a.integer("--width", "N", w.width, "pixels (512; of a face with --camera cube: 256)");
    a.integer(
        "--height", "N", w.height,
        "pixels (from the aspect ratio of the scene's camera, otherwise 512; half the width with --camera latlong)");
    a.text("--camera", "N|NAME|cube|latlong", w.camera,
           "the camera of the scene to use, 1 is the first (1); cube or latlong: every direction "
           "from --camera-position (the middle of the scene), as an environment to bake or to convert");
    a.numbers("--camera-position", "x,y,z", w.camera_position,
              "the eye (that of the scene's camera, or of one that shows all of it)");
    a.numbers("--camera-target", "x,y,z", w.camera_target, "the point that the camera looks at (0,0,0)");
    a.number("--fov-deg", "DEGREES", w.fov_deg, "vertical field of view with --camera-position, 0.1 to 170 (35)");
    a.choice("--background", w.background, "what is seen where there is no surface (environment)");
    a.text("--background-color,--background-colour", "#rrggbb|R,G,B", w.background_color,
           "the colour of the background, sRGB or linear (#ffffff)");
    a.number("--background-roughness", "R", w.background_roughness, "how blurred the background is, 0 to 1 (0.35)");
    a.flag("--shadow-catcher", w.shadow_catcher, "an invisible ground under the scene that receives its shadow");
    a.choice("--tonemap", w.tonemap, "tone map of a .png or .jpg (agx)");
    a.number("--ev", "STOPS", w.ev,
             "exposure of a .png or .jpg (from the log-average luminance of what the surfaces show)");
    a.group("Turntable");
    a.integer("--frames", "N", w.frames,
              "2 to 9999 numbered pictures of one turn, and with .png or .jpg also a .webp animation");
    a.choice("--turn", w.turn, {"camera", "environment"}, "what turns (camera)");
    a.number("--fps", "N", w.fps, "frames a second of the animation, 1 to 1000 (30)");
    a.flag("--resume", w.resume, "keep the frames that exist, render the others");
    a.group("The light");
    a.texts("--env", "ENV", w.environment_files, fmt::format("the environment ({})", k_built_in_sky));
    a.texts("--lights", "FILE", w.light_files, k_lights_help);
    a.number(
        "--lux-per-unit", "LUX", w.lux_per_unit,
        "the illuminance in lux that an irradiance of 1 in the environment's unit stands for; used for glTF lights "
        "of the scene and of --lights whose file does not state it (683, in lm/W for radiance in W/(m^2 sr))");
    add_environment_options(a, w.environment);
    a.group("How it is computed");
    a.choice("--shading", w.shading, shadings(),
             "reference: path tracing; the others draw like a real-time engine: split-sum, stretched and phong from "
             "baked maps, mirror and refract from the environment itself or a texture of it (reference)");
    a.choice("--strategy", w.strategy, "reference: how light directions are sampled (mis)");
    a.integer("--spp", "N", w.spp, "samples of each pixel, 1 to 2^20 (64)");
    a.number("--noise", "X", w.noise,
             "reference: take more samples, up to 65536, where the standard error of L/(1+L) of a pixel is above this, "
             "0 to 1; 0 takes no more (0)");
    a.number("--time", "SECONDS", w.time, "reference: as many samples as fit into this time");
    a.integer("--bounces", "N", w.bounces,
              "reference: bounces of indirect light, 0 to 1000; 0 is direct light with shadows (4)");
    a.choice("--occlusion", w.occlusion, std::vector<NamedValue<bool>>{{true, "on"}, {false, "off"}},
             "off: no shadows, no indirect light and no occlusion maps, to compare with a shader that has none (on)");
    a.flag("--multiple-scattering", w.multiple_scattering,
           "compensate the energy that single scattering loses on "
           "rough surfaces");
    a.text("--maps", "DIR", w.maps,
           "split-sum, stretched, phong: the folder of a bake by `domelight bake` for the generic engine, with the "
           "lobe that the shading needs: ggx, or for phong a Phong lobe (baked in memory)");
    a.text("--probes", "DIR", w.probes,
           "split-sum, stretched, phong: the folder of a set by `domelight probes`; each point is lit by the probes "
           "around it, and --env is the background alone");
    a.choice("--parallax", w.parallax, std::vector<NamedValue<bool>>{{true, "on"}, {false, "off"}},
             "off: reflections are looked up in a probe as if the point were where it is (on)");
    a.integer("--probe-blend", "N", w.probe_blend, "the most probes that are blended at a point, 1 to 8 (8)");
    a.choice("--probe-visibility", w.probe_visibility, std::vector<NamedValue<bool>>{{true, "on"}, {false, "off"}},
             "off: all probes of a cell count, also those behind walls, as in engines that know no visibility (on)");
    a.number("--probe-offset", "X", w.probe_offset,
             "move each point along its normal by this part of the grid's spacing before the probes around it are "
             "looked up, 0 to 1; three.js: 0.5 (0)");
    a.choice("--irradiance", w.sh_irradiance, std::vector<NamedValue<bool>>{{false, "cube"}, {true, "sh"}},
             "split-sum, stretched, phong: the irradiance cube, or nine harmonics (cube)");
    a.choice(
        "--lookup", w.lookup,
        "mirror, refract: the texture through which the environment is looked up; environment: none, it is looked up "
        "directly (environment)");
    a.integer("--lookup-size", "N", w.lookup_size,
              "size of that texture in texels, 1 to 8192: of a cube's face, of a sphere map, of the square of one "
              "paraboloid, or the height of a lat-long map (512)");
    a.choice("--brdf", w.brdf, {"scene", "phong"},
             "phong: modified Phong lobes of matching width instead of GGX, the reference for --shading phong (scene)");
    a.flag("--bent-lookup", w.bent_lookup, "split-sum: move the lookup towards the normal on rough surfaces");
    a.choice("--diffuse-weight", w.diffuse_weight,
             "split-sum, stretched: weight of the diffuse layer; energy: 1 - (F0 scale + F90 bias), what the specular "
             "layer does not reflect; fresnel: 1 - F(NdotV), as in many shaders (energy)");
    a.integer("--seed", "N", w.seed, "another randomisation (0)");
    a.number("--save-every", "SECONDS", w.save_every,
             "reference: write the picture so far at this interval, and when interrupted");
    a.flag("--study", w.study,
           "instead of a picture, draw three figures: the error of each sampling strategy by light and surface, the "
           "noise over the number of samples, and the error of split-sum. With -o DIR they are three .png files and "
           "study.json, with -o FILE.png one picture. This takes minutes");
    add_common_options(a, w.common);
}

void print_result(const RenderWords& w, const Scene& scene, const RenderResult& r, const RenderOptions& o, double ev) {
    const std::vector<std::string> lost = non_finite_warning(r.non_finite_samples);
    print_warnings(lost, w.common, w.scene_name());
    if (w.common.json) {
        Json json{{"version", version()},      {"files", w.outputs},          {"width", o.width},
                  {"height", o.height},        {"shading", w.shading_name()}, {"triangles", scene.triangle_count()},
                  {"samples", r.sample_count}, {"seconds", r.seconds},        {"ev", ev}};
        if (w.reference()) json["noise"] = r.noise, json["rays"] = r.rays;
        json["non_finite_samples"] = r.non_finite_samples;
        json["warnings"] = with_options(scene.warnings);
        print_document(json);
    } else if (!w.common.quiet) {
        print("{}: {} x {}, {} triangles, {} sample{} a pixel{}, {:.2f} s", join(w.outputs, ", "), o.width, o.height,
              scene.triangle_count(), r.sample_count, r.sample_count == 1 ? "" : "s", o.noise > 0 ? " at most" : "",
              r.seconds);
        if (w.reference())
            print(", {}, {:.2f} million rays a second",
                  r.sample_count > 1 ? fmt::format("noise {:.4f} of L/(1+L)", r.noise) : "noise unknown",
                  double(r.rays) / r.seconds * 1e-6);
        print("{}\n", exposure_text(w, ev));
    }
}

/// One picture; with --save-every it is also written while it is being rendered.
int run_picture(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                const EngineLight& light, RenderOptions options) {
    using Clock = std::chrono::steady_clock;
    Interruption interruption;
    auto saved = Clock::now();
    int saved_samples = 0;
    std::optional<Error> failure;
    Result<FinishedPicture> picture = Error{"", "", ""};
    {
        ProgressBar bar(w.scene_name(), w.common);
        options.progress = [&](std::string_view stage, double done) {
            bar.update(stage, done);
            return !Interruption::wanted() && !failure;
        };
        options.status = [&](const RenderStatus& s) {
            bar.detail(fmt::format("{:.0f} samples, noise {:.4f}", s.samples, s.noise));
        };
        if (w.save_every > 0) {
            options.checkpoint_wanted = [&] {
                return std::chrono::duration<double>(Clock::now() - saved).count() >= w.save_every;
            };
            options.checkpoint = [&](const RenderResult& so_far) {
                if (failure) return;
                RenderOptions quiet = options;
                quiet.progress = {};
                const auto finished = finish(w, scene, sampler, quiet, so_far, w.ev);
                if (auto ok = finished ? write_pictures(w.outputs, *finished, scene.scene(), w) : finished.error(); !ok)
                    failure = ok.error();
                saved = Clock::now();
                saved_samples = so_far.sample_count;
            };
        }
        picture = draw_finished(w, scene, sampler, light, options, w.ev);
    }
    if (failure) return print_error(*failure);
    if (!picture && Interruption::wanted())
        return interruption.end(saved_samples > 0 ? fmt::format("{} holds the picture of {} samples a pixel",
                                                                join(w.outputs, ", "), saved_samples)
                                                  : fmt::format("nothing was written to {}", join(w.outputs, ", ")));
    if (!picture) return print_error(picture.error());
    if (auto ok = write_pictures(w.outputs, *picture, scene.scene(), w); !ok) return print_error(ok.error());
    print_result(w, scene.scene(), picture->result, options, picture->ev);
    return exit_done;
}

void warn_of_idle(const RenderWords& w, const Arguments& arguments) {
    const bool screen = std::ranges::any_of(w.outputs, is_screen_picture);
    const bool from_texture = w.shading == ShadingModel::mirror || w.shading == ShadingModel::refract;
    const bool from_maps = !w.reference() && !from_texture && w.probes.empty();
    warn_of_idle_options(arguments,
                         {{"--tonemap", screen, "a .png or .jpg"},
                          {"--ev", screen, "a .png or .jpg"},
                          {"--fov-deg", !w.camera_position.empty(), "--camera-position"},
                          {"--strategy", w.reference(), "--shading reference"},
                          {"--noise", w.reference(), "--shading reference"},
                          {"--time", w.reference(), "--shading reference"},
                          {"--bounces", w.reference(), "--shading reference"},
                          {"--maps", from_maps, "--shading split-sum, stretched or phong"},
                          {"--irradiance", from_maps || !w.probes.empty(), "--shading split-sum, stretched or phong"},
                          {"--lookup", from_texture, "--shading mirror or refract"},
                          {"--lookup-size", from_texture, "--shading mirror or refract"},
                          {"--bent-lookup", w.shading == ShadingModel::split_sum, "--shading split-sum"}},
                         w.common);
}

/// Whether the pictures can be written, and are none of the files that are read.
Result<void> check_places(const RenderWords& w) {
    if (w.study && !is_screen_picture(w.outputs[0])) return check_output_folder(w.outputs[0]);
    std::vector<std::filesystem::path> inputs = environment_files(w.environment_files);
    for (const auto* files : {&w.scenes, &w.light_files}) inputs.insert(inputs.end(), files->begin(), files->end());
    if (!w.frames) return check_output_places(w.outputs, inputs);
    std::vector<std::string> first;
    for (const std::string& output : w.outputs) {
        first.push_back(frame_file(output, 1));
        for (int frame = 1; frame <= *w.frames; ++frame)
            if (auto ok = check_not_an_input(frame_file(output, frame), inputs); !ok) return ok;
    }
    return check_output_places(first);
}

}  // namespace

Result<RenderResult> draw(const RenderWords& w, const RayScene& scene, const EnvironmentSampler& sampler,
                          const EngineLight& light, const RenderOptions& o) {
    if (w.reference()) return render_reference(scene, sampler, o);
    ShadingOptions shading;
    shading.model = *w.shading;
    shading.lookup = w.lookup;
    shading.lookup_size = w.lookup_size.value_or(shading.lookup_size);
    shading.sh_irradiance = w.sh_irradiance;
    shading.bent_lookup = w.bent_lookup;
    shading.multiple_scattering = w.multiple_scattering;
    shading.diffuse_weight = w.diffuse_weight;
    shading.occlusion = o.occlusion;
    return light.probes ? render_shaded(scene, *light.probes, sampler, shading, o)
                        : render_shaded(scene, *light.maps, sampler, shading, o);
}

int run_render(const std::vector<std::string>& words) {
    RenderWords w;
    Arguments arguments(
        "render",
        "Renders a scene under an environment: the reference by path tracing, or what a real-time engine would draw.",
        {"domelight render spheres -o spheres.png --width 256 --height 128 --spp 4",
         "domelight render helmet.glb --env sunset.hdr -o truth.exr,truth.png --spp 256",
         "domelight render ball --env sunset.hdr --shading split-sum -o engine.png",
         "domelight render helmet.glb --background transparent --shadow-catcher -o cut-out.png",
         "domelight render spheres --probes probes --shading split-sum -o probes.png --spp 4",
         "domelight render ball --frames 60 --spp 32 -o ball.png",
         "domelight render --study --env sunset.hdr -o study"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (auto ok = check_words(w, arguments); !ok) return print_error(ok.error(), exit_usage);
    if (auto ok = check_places(w); !ok) return print_error(ok.error());
    if (!w.study) warn_of_idle(w, arguments);

    SceneOptions scene_options;
    scene_options.threads = w.threads();
    scene_options.lux_per_unit = float(w.lux_per_unit);
    const std::string name = w.scene_name();
    std::optional<Scene> scene;
    if (!name.empty()) {
        auto loaded = open_scene(name, scene_options);
        if (!loaded) return print_error(loaded.error());
        scene = std::move(*loaded);
        if (w.brdf == "phong")
            for (Material& m : scene->materials) m.phong = true;
        print_warnings(scene->warnings, w.common, name);
        print_warnings(w.shading ? not_rendered(*scene, *w.shading) : not_rendered(*scene), w.common, name);
    }
    w.environment.threads = w.threads();
    const auto open = [&] { return open_light_to_draw_from(w.environment_files, w.environment); };
    if (w.study) {
        auto environment = open();
        return environment ? run_study(w, std::move(scene), *environment) : print_error(environment.error());
    }
    auto options = render_options(w, *scene);
    if (!options) return print_error(options.error());
    auto environment = open();
    if (!environment) return print_error(environment.error());
    const auto probes = probes_for(w, *scene);
    if (!probes) return print_error(probes.error());
    auto lights = environment_lights(w.light_files, w.environment, scene_options, w.common);
    if (!lights) return print_error(lights.error());
    options->environment_lights = std::move(*lights);

    auto traced = RayScene::build(std::move(*scene));
    if (!traced) return print_error(traced.error().at(name));
    auto sampler =
        EnvironmentSampler::build(*environment, reference_sampler_options(options->strategy, options->threads));
    if (!sampler) return print_error(sampler.error());
    print_warnings(environment->report().lines(), w.common, join(w.environment_files, " "));
    const auto maps = maps_for(w, *sampler);
    if (!maps) return print_error(maps.error());
    std::optional<ProbeBlender> blender;
    if (*probes) blender.emplace(**probes, blend_options(w));
    const EngineLight light{*maps ? &**maps : nullptr, blender ? &*blender : nullptr};
    options->background_maps = light.maps;
    return w.frames ? run_turntable(w, *traced, *sampler, light, *options)
                    : run_picture(w, *traced, *sampler, light, *options);
}

}  // namespace domelight::cli
