#include "domelight/base/version.h"
#include "domelight/capture/probe_bake.h"
#include "domelight/capture/probe_plan.h"
#include "domelight/probe/probe_check.h"
#include "domelight/probe/scene_hash.h"

#include "cli/commands.h"
#include "cli/console/console.h"
#include "cli/console/environment_options.h"
#include "cli/console/field_options.h"
#include "cli/console/interruption.h"
#include "cli/console/light_options.h"
#include "cli/console/print.h"
#include "cli/probes/probes_engines.h"
#include "cli/probes/probes_options.h"
#include "io/file/json.h"
#include "io/file/output_place.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight::cli {
namespace {

void declare(Arguments& a, ProbesWords& w) {
    a.positional(
        "SCENE", w.scenes,
        "a .glb, .gltf, .obj or .ply, or a built-in scene; or the folder of a set of probes, to write it for an "
        "engine");
    a.texts("--env", "ENV", w.environment_files, fmt::format("the environment; without it {}", k_built_in_sky));
    a.texts("--lights", "FILE", w.light_files, k_lights_help);
    a.text("-o,--output", "DIR", w.output, "the folder for probes.json and its .ktx2 files");
    a.text("--check", "DIR", w.check,
           "captures nothing: whether the set of probes in DIR is whole, and still that of SCENE (and of --env)");
    a.group("Placement (one of the first four)");
    a.numbers("--grid", "NX,NY,NZ", w.grid, "a regular grid of so many places that fills the region");
    a.number("--density", "D", w.density,
             "a regular grid with D probes to the square metre: neighbours are 1 / sqrt(D) metres apart on every axis");
    a.texts("--at", "X,Y,Z", w.at, "a place in metres; may be given several times");
    a.integer("--auto", "N", w.auto_count,
              "up to N places, 8 or more: first in about cubic cells, then where the light changes most");
    a.numbers("--region", "X0,Y0,Z0,X1,Y1,Z1", w.region,
              "two corners of the box that --grid, --density and --auto fill, in metres (the box around the scene)");
    a.number("--nearest", "M", w.nearest,
             "metres that a probe keeps from surfaces (a twentieth of the spacing, or 0.1)");
    a.number("--farthest", "M", w.farthest,
             "metres by which a probe may be moved out of geometry (0.45 of the spacing, or 0.5); 0: none is moved");
    a.text("--influence", "WHERE", w.influence,
           "where a probe contributes: everywhere, room (the box of --proxy, fading over its last tenth), or a radius "
           "in metres (everywhere)");
    a.text("--proxy", "BOX", w.proxy,
           "the box of the walls, for the correction of parallax: room (what rays from the probe meet on each side), "
           "none, or "
           "x0,y0,z0,x1,y1,z1 (room)");
    a.group("Capture");
    a.integer("--size", "N", w.size, "texels along a face of each probe's cube, 8 to 1024 (64)");
    a.integer("--spp", "N", w.spp, "samples of each texel (32)");
    a.number("--noise", "E", w.noise,
             "texels get more samples while their error, of L / (1 + L), is above this (0: off)");
    a.integer("--bounces", "N", w.bounces, "bounces of indirect light (3)");
    a.integer("--seed", "N", w.seed, "of the random numbers (0)");
    a.number(
        "--lux-per-unit", "LUX", w.lux_per_unit,
        "the illuminance that a radiance of 1 from all around stands for, over pi: scales the scene's lights (683)");
    a.group("Files");
    a.number(
        "--budget", "MB", w.budget,
        "chooses --size, a power of two from 8 to 512, so that the files of the set have at most so many megabytes");
    a.integer("--levels", "N", w.levels, "levels of the specular chain (down to 4 x 4 texels)");
    a.integer("--irradiance-size", "N", w.irradiance_size, "texels along a face of the irradiance (16)");
    a.integer("--distance-size", "N", w.distance_size,
              "texels along a face of the distances: a whole part of --size; 0: none (32)");
    a.texts("--for", "ENGINE", w.engines,
            "also writes the set for an engine, into a folder of its name: three, a LightProbeGrid; bevy, an "
            "IrradianceVolume; any other of `bake --for`, a bake of each probe with its place; may be given several "
            "times");
    a.choice("--encoding", w.encoding, with_names({Encoding::rgb9e5, Encoding::rgba16f, Encoding::rgba32f}),
             "of the light (rgb9e5)");
    add_environment_options(a, w.environment);
    add_common_options(a, w.common);
}

ProbePlanOptions plan_options(const ProbesWords& w) {
    ProbePlanOptions o;
    o.at = w.places;
    for (std::size_t i = 0; i < w.grid.size(); ++i) o.grid[i] = int(w.grid[i]);
    o.density = w.density;
    o.auto_count = w.auto_count.value_or(0);
    if (!w.region.empty())
        o.region = {Vec3f(Vec3d{w.region[0], w.region[1], w.region[2]}),
                    Vec3f(Vec3d{w.region[3], w.region[4], w.region[5]})};
    o.nearest = float(w.nearest), o.farthest = float(w.farthest);
    o.walls = w.proxy == "room";
    o.proxy = w.box;
    o.influence = w.shape, o.radius = w.radius;
    o.bounces = std::min(2, w.bounces.value_or(2));
    o.seed = std::uint64_t(w.seed.value_or(0));
    o.threads = w.threads();
    return o;
}

std::vector<std::string> sentences(const std::vector<Probe>& probes) {
    const auto moved = std::ranges::count_if(probes, [](const Probe&p) { return p.moved; }),
               invalid = std::ranges::count_if(probes, [](const Probe&p) { return !p.valid; });
    std::vector<std::string> lines;
    if (moved > 0) lines.push_back(fmt::format("{} of {} probes were moved away from surfaces", moved, probes.size()));
    if (invalid > 0)
        lines.push_back(
            fmt::format("{} of {} probes lie inside bodies: each was given the light of the valid probe "
                        "with the fewest surfaces between",
                        invalid, probes.size()));
    return lines;
}

void print_result(const ProbesWords& w, const std::vector<Probe>& probes, const ProbeBakeReport& report) {
    const auto moved = std::ranges::count_if(probes, [](const Probe&p) { return p.moved; }),
               invalid = std::ranges::count_if(probes, [](const Probe&p) { return !p.valid; });
    if (w.common.json) {
        print_document({{"version", version()},
                        {"folder", w.output},
                        {"probes", probes.size()},
                        {"size", report.size},
                        {"moved", moved},
                        {"invalid", invalid},
                        {"rays", report.rays},
                        {"capture_cpu_seconds", report.capture_seconds},
                        {"filter_cpu_seconds", report.filter_seconds},
                        {"non_finite_samples", report.non_finite_samples},
                        {"clipped_texels", report.clipped_texels},
                        {"bytes", report.bytes}});
        return;
    }
    if (w.common.quiet) return;
    print("{}: {} probes of {} x {} texels a face, {:.1f} MB\n", w.output, probes.size(), report.size, report.size,
          double(report.bytes) / 1e6);
    for (const std::string& line : sentences(probes)) print("  {}\n", line);
    print("  {:.3g} million rays in {:.1f} s, filtered in {:.2f} s of processor time\n", double(report.rays) / 1e6,
          report.capture_seconds, report.filter_seconds);
}

std::vector<std::string> warnings_of(const ProbeBakeReport& report) {
    std::vector<std::string> warnings;
    if (report.non_finite_samples > 0)
        warnings.push_back(fmt::format("{} samples are not finite and count as black", report.non_finite_samples));
    if (report.clipped_texels > 0)
        warnings.push_back(
            fmt::format("{} texels are brighter than `encoding` can hold and were clipped", report.clipped_texels));
    return warnings;
}

int run_capture(const ProbesWords& w, Scene scene, const Environment& environment, std::vector<PunctualLight> lights) {
    ProbeBakeOptions options;
    options.capture = w.capture();
    options.filter.levels = w.levels.value_or(0);
    options.filter.irradiance_size = w.irradiance_size.value_or(16);
    options.filter.distance_size = w.distance_size.value_or(-1);
    options.encoding = w.encoding;
    if (auto ok = set_sources(options, w.scene_name(), scene, environment); !ok) return print_error(ok.error());
    options.inputs.insert(options.inputs.end(), w.light_files.begin(), w.light_files.end());
    options.capture.environment_lights = std::move(lights);

    ProbeBakerOptions filter = options.filter;
    filter.size = options.capture.size;
    if (auto ok = w.budget > 0 ? Result<void>() : check_baker_options(filter); !ok)
        return print_error(with_options(ok.error()));

    auto traced = RayScene::build(std::move(scene));
    if (!traced) return print_error(traced.error().at(w.scene_name()));
    auto sampler = EnvironmentSampler::build(environment, reference_sampler_options(LightStrategy::mis, w.threads()));
    if (!sampler) return print_error(sampler.error());
    print_warnings(environment.report().lines(), w.common, join(w.environment_files, " "));
    Result<ProbePlan> plan = Error{};
    Result<ProbeBakeReport> report = Error{};
    {
        ProgressBar bar(w.output, w.common);
        ProbePlanOptions wanted = plan_options(w);
        wanted.progress = bar.callback();
        plan = plan_probes(*traced, *sampler, wanted);
        if (!plan) return print_error(with_options(plan.error()));
        options.placement = plan->how;
        if (w.budget > 0) {
            const auto size = size_for_budget(options.filter, options.encoding, std::uint64_t(w.budget * 1e6),
                                              int(plan->probes.size()));
            if (!size) return print_error(with_options(size.error()));
            options.capture.size = *size;
        }
        options.capture.progress = bar.callback();
        report = bake_probes(*traced, *sampler, plan->probes, plan->grid, options, w.output);
    }
    if (!report) return print_error(with_options(report.error()));
    print_warnings(with_options(warnings_of(*report)), w.common, w.output);
    print_result(w, plan->probes, *report);
    return w.engines.empty() ? exit_done : write_for_engines(w, w.output, w.output);
}

/// --check.
int check_set(const ProbesWords& w, const Scene& scene) {
    ProbeCheck check{scene_sha256(scene), ""};
    if (!w.environment_files.empty()) {
        const auto environment = open_light_to_draw_from(w.environment_files, w.environment);
        if (!environment) return print_error(environment.error());
        const auto hash = environment_sha256(*environment);
        if (!hash) return print_error(hash.error());
        check.environment_sha256 = *hash;
    }
    const auto changes = check_probe_set(w.check, check);
    if (!changes) return print_error(changes.error());
    if (w.common.json)
        print_document({{"version", version()}, {"folder", w.check}, {"changes", *changes}});
    else if (!w.common.quiet && changes->empty())
        print("{}: whole, and of this scene\n", w.check);
    for (const std::string& change : *changes) print_error({change, w.check, "Capture it again: domelight probes."});
    return changes->empty() ? exit_done : exit_failed;
}

}  // namespace

int run_probes(const std::vector<std::string>& words) {
    ProbesWords w;
    Arguments arguments("probes",
                        "Captures the light at many points of a scene by path tracing, filters each as `bake` does, "
                        "and writes all of them as one set of probes.",
                        {"domelight probes spheres -o probes --grid 3,1,1 --size 16 --spp 4",
                         "domelight probes helmet.glb --env sunset.hdr -o near --at 0,0,3 --at 3,0,0 --spp 4",
                         "domelight probes probes --for three -o three"});
    declare(arguments, w);
    if (const auto code = begin_command(arguments, words, w.common)) return *code;
    if (auto ok = check_words(w, arguments); !ok) return print_error(ok.error(), exit_usage);
    if (w.check.empty())
        if (auto ok = check_output_folder(w.output); !ok) return print_error(ok.error());

    if (names_a_set(w)) return write_for_engines(w, w.scene_name(), w.output);
    SceneOptions scene_options;
    scene_options.threads = w.threads();
    scene_options.lux_per_unit = float(w.lux_per_unit);
    const std::string name = w.scene_name();
    auto scene = open_scene(name, scene_options);
    if (!scene) return print_error(scene.error());
    print_warnings(scene->warnings, w.common, name);
    print_warnings(not_rendered(*scene), w.common, name);
    w.environment.threads = w.threads();
    if (!w.check.empty()) return check_set(w, *scene);
    auto environment = open_light_to_draw_from(w.environment_files, w.environment);
    if (!environment) return print_error(environment.error());
    auto lights = environment_lights(w.light_files, w.environment, scene_options, w.common);
    if (!lights) return print_error(lights.error());
    return run_capture(w, *std::move(scene), *environment, *std::move(lights));
}

}  // namespace domelight::cli
