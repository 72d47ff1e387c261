// Jobs that capture the light at many points of a scene.
#include "domelight/capture/probe_bake.h"
#include "domelight/capture/probe_plan.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/probe/scene_hash.h"
#include "domelight/render/render.h"
#include "domelight/sampling/environment_sampler.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"
#include "batch/scene_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

struct ProbesJob {
    std::string scene;
    double lux_per_unit = 683, nearest = 0, farthest = -1;
    std::vector<double> grid, region, at;
    ProbePlanOptions plan;
    ProbeBakeOptions bake;
    EnvironmentOptions environment;
};

/// Numbers of metres, in groups of `of`.
void check_metres(OptionReader& reader, const char* name, const std::vector<double>& numbers, std::size_t of) {
    if (numbers.size() % of != 0)
        reader.fail({fmt::format("{} numbers, expected {} or a multiple", numbers.size(), of), field_place(name), ""});
    for (const double v : numbers)
        if (!(std::abs(v) <= 1e9))
            reader.fail({fmt::format("{:g} is not finite and within 1e9 metres", v), field_place(name), ""});
}

void read_placement(OptionReader& reader, ProbesJob& job) {
    reader.read("grid", job.grid);
    reader.read("density", job.plan.density, 1e-9, 1e9);
    reader.read("at", job.at);
    reader.read("auto", job.plan.auto_count, 8, 1 << 20);
    reader.read("region", job.region);
    reader.read("nearest", job.nearest, 1e-6, 1e6);
    reader.read("farthest", job.farthest, 0, 1e6);
    check_metres(reader, "at", job.at, 3);
    check_metres(reader, "region", job.region, 6);
    int ways = 0;
    for (const char* way : {"grid", "density", "at", "auto"}) ways += reader.given(way);
    if (ways != 1)
        reader.fail({fmt::format("{} of `grid`, `density`, `at` and `auto` are given", ways), "",
                     "Say in one of these ways where the probes are to be."});
    if (!job.grid.empty() && job.grid.size() != 3)
        reader.fail({"is not three numbers", field_place("grid"), "[nx, ny, nz]"});
    for (std::size_t i = 0; i < std::min<std::size_t>(3, job.grid.size()); ++i) {
        if (!(job.grid[i] >= 1 && job.grid[i] <= 4096 && job.grid[i] == std::floor(job.grid[i])))
            reader.fail(
                {fmt::format("{:g} is not a number of places from 1 to 4096", job.grid[i]), field_place("grid"), ""});
        else
            job.plan.grid[i] = int(job.grid[i]);
    }
}

Result<ProbesJob> options_of(const Json& json) {
    OptionReader reader(json);
    ProbesJob job;
    CaptureOptions& c = job.bake.capture;
    c.size = 64;
    c.samples = 32;
    c.bounces = 3;
    read_scene_option(reader, job.scene);
    read_placement(reader, job);
    reader.read("size", c.size, 8, 1024);
    reader.read("spp", c.samples, 1, 1 << 20);
    reader.read("noise", c.noise, 0, 1);
    reader.read("bounces", c.bounces, 0, 1000);
    reader.read("seed", c.seed);
    reader.read("lux_per_unit", job.lux_per_unit, 1e-12, 1e12);
    job.bake.filter.irradiance_size = 16;
    job.bake.filter.distance_size = -1;
    reader.read("levels", job.bake.filter.levels, 2, 11);
    reader.read("irradiance_size", job.bake.filter.irradiance_size, 1, 256);
    reader.read("distance_size", job.bake.filter.distance_size, 0, 1024);
    reader.read("encoding", job.bake.encoding);
    read_environment_options(reader, job.environment);
    if (auto ok = reader.finish(); !ok) return ok.error();
    c.most_samples = std::max(1024, 16 * c.samples);
    ProbePlanOptions& p = job.plan;
    const auto point = [](const std::vector<double>& v, std::size_t i) {
        return Vec3f(Vec3d{v[i], v[i + 1], v[i + 2]});
    };
    for (std::size_t i = 0; i < job.at.size(); i += 3) p.at.push_back(point(job.at, i));
    if (!job.region.empty()) p.region = ProbeBox{point(job.region, 0), point(job.region, 3)};
    p.nearest = float(job.nearest);
    p.farthest = float(job.farthest);
    p.bounces = std::min(2, reader.given("bounces") ? c.bounces : 2);
    p.seed = c.seed;
    return job;
}

/// How many probes there will be, as far as the options tell.
double count_of(const ProbesJob& job) {
    if (!job.grid.empty()) return job.grid[0] * job.grid[1] * job.grid[2];
    if (!job.at.empty()) return double(job.at.size()) / 3;
    return job.plan.auto_count > 0 ? job.plan.auto_count : 100;
}

JobEstimate estimate(const Json& json, std::span<const InputFacts> inputs) {
    const auto job = options_of(json);
    if (!job) return {1, 1 << 28};
    std::int64_t texels = 0;
    for (const InputFacts& input : inputs) texels += input.texels();
    const CaptureOptions& c = job->bake.capture;
    const double paths = count_of(*job) * 6 * c.size * c.size * c.samples;
    return {0.2 + 0.3e-6 * double(texels) + 0.25e-6 * paths * (1 + 0.5 * c.bounces),
            (std::int64_t(250) << 20) + 60 * texels};
}

std::vector<std::string> warnings_of(const ProbeBakeReport& report, const std::vector<Probe>& probes) {
    std::vector<std::string> warnings;
    const auto invalid = std::ranges::count_if(probes, [](const Probe& p) { return !p.valid; });
    if (invalid > 0) warnings.push_back(fmt::format("{} of {} probes lie inside bodies", invalid, probes.size()));
    if (report.non_finite_samples > 0)
        warnings.push_back(fmt::format("{} samples are not finite and count as black", report.non_finite_samples));
    if (report.clipped_texels > 0)
        warnings.push_back(
            fmt::format("{} texels are brighter than the encoding can hold and were clipped", report.clipped_texels));
    return warnings;
}

Result<JobReport> run(const JobCall& call) {
    auto job = options_of(call.options);
    if (!job) return job.error();
    job->plan.threads = job->bake.capture.threads = job->environment.threads = call.threads;
    auto scene = open_scene(call, job->scene, job->lux_per_unit);
    if (!scene) return scene.error();
    const auto environment = open_environment(call.files("environment"), job->environment);
    if (!environment) return environment.error();
    const auto file = call.inputs.find("scene");
    const std::string name = file == call.inputs.end() ? job->scene : file->second[0].string();
    if (auto ok = set_sources(job->bake, name, *scene, *environment); !ok) return ok.error();
    JobReport report;
    report.warnings = scene->warnings;
    for (const std::string& line : not_rendered(*scene)) report.warnings.push_back(line);
    const auto traced = RayScene::build(*std::move(scene));
    if (!traced) return traced.error();
    const auto sampler =
        EnvironmentSampler::build(*environment, reference_sampler_options(LightStrategy::mis, call.threads));
    if (!sampler) return sampler.error();
    const auto plan = plan_probes(*traced, *sampler, job->plan);
    if (!plan) return plan.error();
    job->bake.placement = plan->how;
    const auto baked = bake_probes(*traced, *sampler, plan->probes, plan->grid, job->bake, call.folder);
    if (!baked) return baked.error();
    note_repairs(*environment, report);
    for (const std::string& line : warnings_of(*baked, plan->probes)) report.warnings.push_back(line);
    return report;
}

}  // namespace

JobKind probes_kind() {
    return {.name = "probes",
            .does = "captures the light at many points of a scene, as `domelight probes` does",
            .roles = {"environment", "scene?"},
            .makes_folder = true,
            .file_name = no_file,
            .check = check_options<options_of>,
            .estimate = estimate,
            .run = run};
}

}  // namespace domelight
