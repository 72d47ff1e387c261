// Jobs that render a scene under an environment.
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/scene/scene.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"
#include "batch/scene_input.h"
#include "preview/exposure_meter.h"
#include "preview/screen_picture.h"
#include "render/render_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

struct RenderJob {
    std::string scene, format = "exr", shading = "reference", brdf = "scene";
    std::optional<ShadingModel> model;  ///< nothing: the reference
    std::optional<int> width, height;
    std::vector<double> position, target;
    double fov_deg = 35, lux_per_unit = 683, background_roughness = 0.35;
    RenderOptions options;
    ShadingOptions shading_options;
    Tonemap tonemap = Tonemap::agx;
    std::optional<double> ev;
    EnvironmentOptions environment;
};

void check_vector(OptionReader& reader, const char* name, const std::vector<double>& v) {
    if (!v.empty() && v.size() != 3) reader.fail({"is not three numbers", field_place(name), "[x, y, z]"});
}

void read_shading(OptionReader& reader, RenderJob& job) {
    std::vector<std::string> accepted = names_of<ShadingModel>();
    accepted.insert(accepted.begin(), "reference");
    reader.read_word("shading", job.shading, accepted, "a model of shading");
    if (const auto model = from_name<ShadingModel>(job.shading)) job.model = *model;
    ShadingOptions& s = job.shading_options;
    reader.read("lookup", s.lookup);
    reader.read("lookup_size", s.lookup_size, 1, 8192);
    reader.read("bent_lookup", s.bent_lookup);
    reader.read("diffuse_weight", s.diffuse_weight);
    std::string irradiance = "cube";
    reader.read_word("irradiance", irradiance, {"cube", "sh"}, "a kind of irradiance");
    s.sh_irradiance = irradiance == "sh";
}

Result<RenderJob> options_of(const Json& json) {
    OptionReader reader(json);
    RenderJob job;
    RenderOptions& o = job.options;
    o.samples = 64;
    o.bounces = 4;
    read_scene_option(reader, job.scene);
    reader.read_word("format", job.format, {"exr", "hdr", "png", "jpg"}, "a format");
    reader.read("width", job.width);
    reader.read("height", job.height);
    reader.read("camera_position", job.position);
    reader.read("camera_target", job.target);
    check_vector(reader, "camera_position", job.position);
    check_vector(reader, "camera_target", job.target);
    reader.read("fov_deg", job.fov_deg, 0.1, 170);
    reader.read("spp", o.samples, 1, 1 << 20);
    reader.read("noise", o.noise, 0, 1);
    reader.read("bounces", o.bounces, 0, 1000);
    reader.read("strategy", o.strategy);
    reader.read("occlusion", o.occlusion);
    reader.read("multiple_scattering", o.multiple_scattering);
    reader.read("background", o.background);
    reader.read("background_roughness", job.background_roughness, 0, 1);
    reader.read("seed", o.seed);
    reader.read("lux_per_unit", job.lux_per_unit, 1e-12, 1e12);
    reader.read_word("brdf", job.brdf, {"scene", "phong"}, "a BRDF");
    read_shading(reader, job);
    reader.read("tonemap", job.tonemap);
    reader.read("ev", job.ev);
    read_environment_options(reader, job.environment);
    if (auto ok = reader.finish(); !ok) return ok.error();
    for (const auto& [name, value] : {std::pair{"width", job.width}, {"height", job.height}})
        if (value && (*value < 1 || *value > 16384))
            return Error{fmt::format("{} is not from 1 to 16384", *value), field_place(name), ""};
    if (o.background == Background::colour)
        return Error{"a background colour is not for batches", field_place("background"),
                     "Render it transparent, and put the colour behind it."};
    o.background_roughness = float(job.background_roughness);
    job.shading_options.multiple_scattering = o.multiple_scattering;
    job.shading_options.occlusion = o.occlusion;
    return job;
}

std::string file_name(const Json& json, const std::string& name) {
    const auto job = options_of(json);
    return with_ending(name, "." + (job ? job->format : "exr"));
}

JobEstimate estimate(const Json& json, std::span<const InputFacts> inputs) {
    const auto job = options_of(json);
    if (!job) return {1, 1 << 28};
    std::int64_t texels = 0;
    for (const InputFacts& input : inputs) texels += input.texels();
    const double width = job->width.value_or(job->height.value_or(512)), height = job->height.value_or(int(width));
    const double paths = width * height * job->options.samples * (job->model ? 1 : 1 + 0.5 * job->options.bounces);
    return {0.2 + 0.3e-6 * double(texels) + 0.25e-6 * paths,
            (std::int64_t(200) << 20) + 60 * texels + std::int64_t(width * height * 140)};
}

/// The camera that was asked for, or the scene's first, and the size of the picture.
void set_camera(RenderJob& job, const Scene& scene) {
    const auto vector = [](const std::vector<double>& v) {
        return v.empty() ? Vec3f{} : Vec3f(Vec3d{v[0], v[1], v[2]});
    };
    const Camera* own = scene.cameras.empty() ? nullptr : &scene.cameras.front();
    SceneView view{job.width, job.height, own, {}, vector(job.target), float(job.fov_deg * k_pi / 180)};
    if (!job.position.empty()) view.eye = vector(job.position);
    set_view(job.options, scene, view);
}

Result<RenderResult> draw(RenderJob& job, const RayScene& scene, const EnvironmentSampler& sampler) {
    std::optional<LightMaps> maps;
    if (job.model || job.options.background == Background::blurred) {
        const Lobe lobe = job.model == ShadingModel::phong ? shading_lobe(ShadingModel::phong) : Lobe::ggx;
        auto baked = LightMaps::bake(sampler.image(), sampler.world_to_source(), job.options.threads, lobe);
        if (!baked) return baked.error();
        maps.emplace(*std::move(baked));
        job.options.background_maps = &*maps;
    }
    if (!job.model) return render_reference(scene, sampler, job.options);
    job.shading_options.model = *job.model;
    return render_shaded(scene, *maps, sampler, job.shading_options, job.options);
}

Result<void> write(const RenderJob& job, const std::filesystem::path& file, const RenderResult& r, const Scene& scene) {
    if (job.format == "exr") return write_render_layers(file, r, r.radiance, scene);
    if (job.format == "hdr") return write_hdr(file, r.radiance, job.options.threads);
    const bool transparent = job.options.background == Background::transparent;
    ExposureMeter meter;
    meter.add(r.radiance, r.opacity, transparent);
    const Display display{job.tonemap, float(std::exp2(job.ev.value_or(meter.ev())))};
    return write_screen_picture(
        file, screen_picture(r.radiance, transparent ? r.opacity.view() : ImageView<const float>(), display,
                             job.options.threads));
}

Result<JobReport> run(const JobCall& call) {
    auto job = options_of(call.options);
    if (!job) return job.error();
    job->options.threads = job->environment.threads = call.threads;
    auto scene = open_scene(call, job->scene, job->lux_per_unit);
    if (!scene) return scene.error();
    if (job->brdf == "phong")
        for (Material& m : scene->materials) m.phong = true;
    JobReport report;
    report.warnings = scene->warnings;
    const auto missing = job->model ? not_rendered(*scene, *job->model) : not_rendered(*scene);
    report.warnings.insert(report.warnings.end(), missing.begin(), missing.end());
    set_camera(*job, *scene);
    const auto environment = open_environment(call.files("environment"), job->environment);
    if (!environment) return environment.error();
    const auto traced = RayScene::build(*std::move(scene));
    if (!traced) return traced.error();
    const auto sampler =
        EnvironmentSampler::build(*environment, reference_sampler_options(job->options.strategy, call.threads));
    if (!sampler) return sampler.error();
    const auto result = draw(*job, *traced, *sampler);
    if (!result) return result.error();
    if (auto ok = write(*job, call.folder / call.name, *result, traced->scene()); !ok) return ok.error();
    note_repairs(*environment, report);
    if (!job->model && result->sample_count > 1) {
        report.error = result->noise;
        report.error_of = "standard error of L/(1+L)";
    }
    report.preview = call.name;
    return report;
}

}  // namespace

JobKind render_kind() {
    return {.name = "render",
            .does = "renders a scene under an environment, as `domelight render` does",
            .roles = {"environment", "scene?"},
            .makes_folder = false,
            .file_name = file_name,
            .check = check_options<options_of>,
            .estimate = estimate,
            .run = run};
}

}  // namespace domelight
