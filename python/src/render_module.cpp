// domelight._render: the path tracer, with Embree. A module of its own, which is loaded when a picture is asked for.

#include "domelight/io/environment/open_environment.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"
#include "domelight/scene/scene.h"

#include "array_input.h"
#include "base/field_place.h"
#include "errors.h"
#include "keywords.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace domelight::python {
namespace {

Vec3f vector_of(const Keywords& words, const char* name) {
    std::vector<double> v;
    words.read(name, v);
    if (v.empty()) return {};
    if (v.size() != 3) throw Failure({fmt::format("{} numbers, expected three", v.size()), field_place(name), ""});
    return Vec3f(Vec3d{v[0], v[1], v[2]});
}

/// Size in pixels and camera: the scene's own, or one that shows all of it.
void read_view(const Keywords& words, const Scene& scene, RenderOptions& options) {
    SceneView view{options.width, {}, scene.cameras.empty() ? nullptr : &scene.cameras.front(), {}, {}, 0};
    words.read("width", view.width);
    words.read("height", view.height);
    check_within("width", *view.width, 1, 16384);
    if (view.height) check_within("height", *view.height, 1, 16384);
    double fov_deg = 35;
    words.read("fov_deg", fov_deg);
    check_within("fov_deg", fov_deg, 0.1, 170);
    view.fov_y = float(fov_deg * k_pi / 180);
    if (words.has("camera_position")) {
        view.eye = vector_of(words, "camera_position");
        view.target = vector_of(words, "camera_target");
    }
    set_view(options, scene, view);
}

RenderOptions render_options(const Keywords& words, const Scene& scene) {
    RenderOptions options;
    read_view(words, scene, options);
    options.bounces = 4;
    words.read("spp", options.samples);
    words.read("noise", options.noise);
    words.read("time", options.seconds);
    words.read("bounces", options.bounces);
    words.read("strategy", options.strategy);
    words.read("occlusion", options.occlusion);
    words.read("multiple_scattering", options.multiple_scattering);
    words.read("background", options.background);
    words.read("seed", options.seed);
    words.read("threads", options.threads);
    options.background_colour = vector_of(words, "background_colour");
    double roughness = options.background_roughness;
    words.read("background_roughness", roughness);
    options.background_roughness = float(roughness);
    check_within("spp", options.samples, 1, 1 << 20);
    check_within("noise", options.noise, 0, 1);
    check_within("time", options.seconds, 0, 1e9);
    check_within("bounces", options.bounces, 0, 1000);
    check_within("background_roughness", roughness, 0, 1);
    check_within("threads", options.threads, 0, 1024);
    return options;
}

struct Shading {
    std::optional<ShadingOptions> options;  ///< nothing: the reference
};

Shading shading_of(const Keywords& words, const RenderOptions& render) {
    std::string word = "reference";
    words.read("shading", word);
    if (word == "reference") return {};
    ShadingOptions options;
    const auto model = from_name<ShadingModel>(word);
    if (!model) {
        auto accepted = names_of<ShadingModel>();
        accepted.insert(accepted.begin(), "reference");
        throw Failure(unknown_name(word, "a model of shading", accepted).at(field_place("shading")));
    }
    options.model = *model;
    words.read("lookup", options.lookup);
    words.read("lookup_size", options.lookup_size);
    words.read("diffuse_weight", options.diffuse_weight);
    options.occlusion = render.occlusion;
    options.multiple_scattering = render.multiple_scattering;
    return {options};
}

Result<RenderResult> draw(Scene scene, const Environment& environment, const Shading& shading, RenderOptions options) {
    auto traced = RayScene::build(std::move(scene));
    if (!traced) return traced.error();
    auto sampler =
        EnvironmentSampler::build(environment, reference_sampler_options(options.strategy, options.threads));
    if (!sampler) return sampler.error();
    std::optional<LightMaps> maps;
    if (shading.options || options.background == Background::blurred) {
        const Lobe lobe = shading.options ? shading_lobe(shading.options->model) : Lobe::ggx;
        auto baked = LightMaps::bake(sampler->image(), sampler->world_to_source(), options.threads, lobe);
        if (!baked) return baked.error();
        maps.emplace(*std::move(baked));
        options.background_maps = &*maps;
    }
    return shading.options ? render_shaded(*traced, *maps, *sampler, *shading.options, options)
                           : render_reference(*traced, *sampler, options);
}

nb::dict told(RenderResult result) {
    nb::dict layers;
    const auto add = [&](const char* name, ImageF& image) {
        if (!image.empty()) layers[name] = numpy_of(std::move(image));
    };
    add("radiance", result.radiance);
    add("opacity", result.opacity);
    add("direct", result.direct);
    add("indirect", result.indirect);
    add("diffuse", result.diffuse);
    add("specular", result.specular);
    add("albedo", result.albedo);
    add("normal", result.normal);
    add("depth", result.depth);
    add("object", result.object);
    add("variance", result.variance);
    add("samples", result.samples);
    nb::dict all;
    all["layers"] = layers;
    all["noise"] = result.noise;
    all["seconds"] = result.seconds;
    all["rays"] = result.rays;
    return all;
}

nb::dict run_render(const std::string& name, const Environment& environment, const nb::dict& dictionary,
                    const nb::object& progress) {
    const Keywords words(dictionary);
    int threads = 0;
    words.read("threads", threads);
    Scene scene = run_work_for(nb::none(), [&](const Progress&) { return value_of(open_scene(name, {.threads = threads})); });
    RenderOptions options = render_options(words, scene);
    const Shading shading = shading_of(words, options);
    std::vector<std::string> warnings = scene.warnings;
    const auto missing = shading.options ? not_rendered(scene, shading.options->model) : not_rendered(scene);
    warnings.insert(warnings.end(), missing.begin(), missing.end());
    nb::dict all = told(run_work_for(progress, [&](const Progress& report) {
        options.progress = report;
        return value_of(draw(std::move(scene), environment, shading, options));
    }));
    all["warnings"] = warnings;
    return all;
}

}  // namespace
}  // namespace domelight::python

NB_MODULE(_render, module) {
    using namespace domelight::python;
    nb::set_leak_warnings(false);
    register_errors();
    module.def("render", &run_render, nb::arg("scene"), nb::arg("environment"), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("built_in_scenes", &domelight::built_in_scene_names);
}
