#include "filtering.h"

#include "domelight/bake/brdf_file.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/prefilter.h"

#include "bake/plan.h"
#include "base/field_place.h"
#include "environment.h"
#include "keywords.h"
#include "maps.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <utility>

namespace domelight::python {
namespace {

/// The chain that `domelight bake` would filter for the generic engine with the same words.
EnginePlan plan_of(const Keywords& words, const BakeOptions& defaults = {}) {
    BakeOptions options = defaults;
    words.read("size", options.size);
    words.read("levels", options.levels);
    words.read("roughness", options.roughness);
    words.read("lobe", options.lobe);
    words.read("exponents", options.exponents);
    words.read("layout", options.layout);
    words.read("texels", options.texels);
    words.read("threads", options.threads);
    return std::move(value_of(plan_bake(options, nullptr)).front());
}

/// Directions go with any number of widths, and with no size.
EnginePlan plan_for_directions(const Keywords& words) {
    for (const char* name : {"size", "levels", "layout", "texels"})
        if (words.has(name)) throw Failure({"does not apply to `directions`", field_place(name), ""});
    BakeOptions options;
    options.size = 16384;  // of no meaning: it allows the most levels
    options.texels = Texels::centre;
    if (!words.has("roughness") && !words.has("exponents"))
        throw Failure({"is missing", field_place("roughness"), "Directions need the roughness of each level."});
    EnginePlan plan = plan_of(words, options);
    for (const LevelPlan& level : plan.specular)
        if (level.spec.mirror)
            throw Failure({"the environment itself is not filtered",
                           field_place(words.has("exponents") ? "exponents" : "roughness"),
                           "Environment.radiance(directions) reads it."});
    return plan;
}

FilterOptions filter_options(const EnginePlan& plan, const Keywords& words) {
    FilterOptions options;
    options.layout = plan.layout;
    options.texels = plan.texels;
    options.sh_bands = 0;
    for (const LevelPlan& level : plan.specular) options.specular.push_back(level.spec);
    words.read("threads", options.threads);
    return options;
}

FilterResult filter(const Environment& environment, FilterOptions options, const nb::object& progress) {
    return run_work_for(progress, [&](const Progress& report) {
        options.progress = report;
        return value_of(prefilter(environment, options));
    });
}

nb::dict run_prefilter(const Environment& environment, const nb::dict& dictionary, const nb::object& progress) {
    const Keywords words(dictionary);
    const bool directed = words.has("directions");
    const EnginePlan plan = directed ? plan_for_directions(words) : plan_of(words);
    FilterOptions options = filter_options(plan, words);
    if (directed) options.directions = directions_of(words.find("directions"), "directions");
    FilterResult result = filter(environment, std::move(options), progress);
    nb::list maps, roughness, exponents, mirror;
    for (std::size_t l = 0; l < plan.specular.size(); ++l) {
        FilteredMap& map = result.specular[l];
        maps.append(array_of(std::move(map), directed));
        roughness.append(plan.specular[l].roughness);
        exponents.append(plan.specular[l].exponent);
        mirror.append(plan.specular[l].spec.mirror);
    }
    nb::dict told;
    told["maps"] = maps;
    told["roughness"] = roughness;
    told["exponents"] = exponents;
    told["mirror"] = mirror;
    told["lobe"] = name_of(plan.lobe);
    told["layout"] = directed ? std::string("directions") : name_of(plan.layout);
    told["texels"] = name_of(plan.texels);
    told["mean"] = tuple_of(result.mean);
    told["clamped"] = result.clamped;
    told["band_limit"] = result.band_limit;
    return told;
}

void check_size(const char* field, int size, int most) {
    if (size < 1 || size > most) throw Failure({fmt::format("{} is not from 1 to {}", size, most), field_place(field), ""});
}

nb::object run_irradiance(const Environment& environment, const nb::dict& dictionary, const nb::object& progress) {
    const Keywords words(dictionary);
    FilterOptions options;
    options.sh_bands = 0;
    options.irradiance_size = 64;
    bool over_pi = false;
    words.read("size", options.irradiance_size);
    words.read("layout", options.layout);
    words.read("over_pi", over_pi);
    words.read("threads", options.threads);
    check_size("size", options.irradiance_size, 4096);
    const bool directed = words.has("directions");
    if (directed) options.directions = directions_of(words.find("directions"), "directions");
    FilterResult result = filter(environment, std::move(options), progress);
    FilteredMap& map = result.irradiance_over_pi;
    if (!over_pi)
        for (float& value : map.pixels()) value = float(value * k_pi);
    return array_of(std::move(map), directed);
}

/// Rows of three as (count, 3) of float64.
nb::object rows_of(const std::vector<Vec3d>& rows) {
    auto owned = std::make_unique<std::vector<Vec3d>>(rows);
    double* const data = owned->empty() ? nullptr : &owned->front().x;
    const std::size_t shape[2] = {rows.size(), 3};
    nb::capsule owner(owned.release(), [](void* p) noexcept { delete static_cast<std::vector<Vec3d>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, double>(data, 2, shape, owner));
}

nb::object run_spherical_harmonics(const Environment& environment, const nb::dict& dictionary,
                                   const nb::object& progress) {
    const Keywords words(dictionary);
    FilterOptions options;
    ShWindow window = ShWindow::none;
    bool irradiance = false;
    words.read("sh_bands", options.sh_bands);
    words.read("sh_window", window);
    words.read("irradiance", irradiance);
    words.read("threads", options.threads);
    check_size("sh_bands", options.sh_bands, 64);
    FilterResult result = filter(environment, std::move(options), progress);
    sh_window(result.sh, window);
    if (!irradiance) return rows_of(result.sh);
    std::vector<Vec3d> of_irradiance = sh_irradiance_over_pi(result.sh);
    for (Vec3d& v : of_irradiance) v *= k_pi;
    return rows_of(of_irradiance);
}

nb::object run_brdf_table(const nb::dict& dictionary) {
    const Keywords words(dictionary);
    BrdfFileOptions options;
    bool montecarlo = false;
    std::string method = "exact";
    PointSet points;
    words.read("size", options.size);
    words.read("g", options.g);
    words.read("form", options.form);
    words.read("threads", options.threads);
    words.read("method", method);
    words.read("samples", points.count);
    words.read("sequence", points.sequence);
    words.read("seed", points.seed);
    check_size("size", options.size, 4096);
    if (method != "exact" && method != "montecarlo")
        throw Failure(unknown_name(method, "a method", std::array<std::string, 2>{"exact", "montecarlo"})
                          .at(field_place("method")));
    if (montecarlo = method == "montecarlo"; montecarlo) {
        check_size("samples", points.count, 1 << 24);
        options.points = points;
    }
    if (options.form == BrdfForm::none)
        throw Failure({"none has no channels", field_place("form"),
                       "Accepted: scale-bias, multiscatter, scale-bias-charlie."});
    return numpy_of(run_work_for(nb::none(), [&](const Progress&) {
        const ImageF table = brdf_table(options);
        const auto shown = options.form == BrdfForm::multiscatter ? brdf_table_multiscatter(table) : table;
        const int channels = options.form == BrdfForm::scale_bias_charlie ? 3 : 2;
        auto kept = ImageF::uninitialized(shown.width(), shown.height(), channels);
        for (int y = 0; y < kept.height(); ++y)
            for (int x = 0; x < kept.width(); ++x) std::copy_n(shown.at(x, y), channels, kept.at(x, y));
        return kept;
    }));
}

}  // namespace

void declare_filtering(nb::module_& module) {
    module.def("prefilter", &run_prefilter, nb::arg("environment"), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("irradiance", &run_irradiance, nb::arg("environment"), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("spherical_harmonics", &run_spherical_harmonics, nb::arg("environment"), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("brdf_table", &run_brdf_table, nb::arg("options"));
}

}  // namespace domelight::python
